// Every way to get a case file wrong, with its helpful message.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ostream>
#include <string>
#include <vector>

#include "tribound/case/config.h"

namespace tribound
{
namespace
{

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

const std::string mesh = "mesh.file = 'a.msh'\n";
const std::string material = "material = {E = 1, nu = 0.3}\n";
const std::string head = mesh + material;  // the case continues in line 3

struct BadCase
{
  std::string name;
  std::string text;
  std::string place;    ///< how the message begins
  std::string problem;  ///< in the message
  std::string hint;     ///< in the message
};

void PrintTo(const BadCase& bad, std::ostream* out)
{
  *out << bad.text;
}

class BadCaseFile : public testing::TestWithParam<BadCase>
{
};

TEST_P(BadCaseFile, IsRejectedWithPlaceProblemAndHint)
{
  const BadCase& bad = GetParam();
  try
  {
    (void)case_file::parse_config(bad.text, "case.toml");
    FAIL() << "accepted";
  }
  catch (const InputError& error)
  {
    const std::string message = error.what();
    EXPECT_EQ(message.substr(0, bad.place.size()), bad.place) << message;
    EXPECT_THAT(message, HasSubstr(bad.problem));
    EXPECT_THAT(error.hint(), HasSubstr(bad.hint));
    EXPECT_FALSE(error.hint().empty()) << message;
  }
}

std::vector<BadCase> syntax()
{
  return {
      {"NotToml", "degree = \n", "case.toml:1:", "not valid TOML", "quotes"},
      {"OpenString", "title = \"abc\ndegree = 1\n", "case.toml:1:", "not valid TOML", "quotes"},
      {"OpenTable", head + "[newton\nmax_steps = 3\n", "case.toml:3:", "not valid TOML", "header"},
      {"BoundaryTwice", head + "[boundary.top]\npressure = 1\n[boundary.top]\npressure = 2\n",
       "case.toml:5:", "boundary \"top\" is given twice", "into one table"},
      {"TableTwice", head + "[newton]\n[newton]\n", "case.toml:4:", "newton: is given twice", "keep one"},
      {"KeyTwice", head + "degree = 1\ndegree = 2\n", "case.toml:4:", "degree: is given twice", "keep one"},
      {"UnknownTopKey", "degre = 2\n" + head, "case.toml:1:1: degre: ", "unknown key",
       "did you mean \"degree\"? allowed here: title, purpose, degree, model, units, parameters, mesh"},
      {"UnknownTable", head + "[plasticity]\n", "case.toml:3:2: plasticity: ", "unknown key",
       "allowed here: "},
      {"UnknownNestedKey", head + "[adapt]\ntolerence = 1\n",
       "case.toml:4:1: adapt.tolerence: ", "unknown key", "did you mean \"tolerance\"?"},
      {"UnknownMaterialKey", mesh + "[material]\nE = 1\nnue = 0.3\n", "case.toml:4:1: material.nue: ",
       "unknown key", "did you mean \"nu\"? allowed here: E, nu, plane, alpha, or tables of single regions"},
      {"UnknownContactKey", head + "[boundary.a]\ncontact = {fricton = 'none'}\n",
       "case.toml:4:12: boundary.a.contact.fricton: ", "unknown key", "did you mean \"friction\"?"},
      {"UnknownBoundaryKey", head + "[boundary.a]\ndisplacment = [0, 0]\n",
       "case.toml:4:1: boundary.a.displacment: ", "unknown key", "did you mean \"displacement\"?"},
      {"NotATable", head + "newton = 3\n", "case.toml:3:10: newton: ", "must be a table, found the integer 3",
       "stopping, gamma_lin"},
      {"BoundaryNotATable", head + "boundary = 'top'\n",
       "case.toml:3:12: boundary: ", "must be a table, found the string \"top\"", "[boundary.top]"},
      {"QuotedName", head + "[boundary.\"left wall\"]\nweight = 1\n",
       "case.toml:4:1: boundary.\"left wall\".weight: ", "unknown key", "traction"},
  };
}

std::vector<BadCase> values()
{
  return {
      {"TitleNotText", "title = 5\n" + head,
       "case.toml:1:9: title: ", "must be a string, found the integer 5", "quotes"},
      {"PurposeNotText", "purpose = [\"why\"]\n" + head,
       "case.toml:1:11: purpose: ", "must be a string, found an array", "quotes"},
      {"DegreeZero", "degree = 0\n" + head, "case.toml:1:10: degree: ", "an integer from 1 to 4, found 0",
       "polynomial degree"},
      {"DegreeFive", "degree = 5\n" + head, "case.toml:1:10: degree: ", "found 5", "degree"},
      {"DegreeNotInteger", "degree = 2.0\n" + head,
       "case.toml:1:10: degree: ", "must be an integer, found the number 2", "degree"},
      {"YoungZero", mesh + "material = {E = 0, nu = 0.3}\n",
       "case.toml:2:17: material.E: ", "must be positive, found 0", "Young's modulus"},
      {"YoungText", mesh + "material = {E = '210e9', nu = 0.3}\n",
       "case.toml:2:17: material.E: ", "must be a number, found the string \"210e9\"", "without quotes"},
      {"YoungInfinite", mesh + "material = {E = inf, nu = 0.3}\n",
       "case.toml:2:17: material.E: ", "must be a finite number, found the number inf", "an ordinary number"},
      {"PoissonHalf", mesh + "[material]\nE = 1\nnu = 0.5\n",
       "case.toml:4:6: material.nu: ", "must lie in (-1, 0.5), found 0.5", "0.499"},
      {"PoissonLow", mesh + "[material.steel]\nE = 1\nnu = -1\n",
       "case.toml:4:6: material.steel.nu: ", "must lie in (-1, 0.5), found -1", "such as 0.3"},
      {"PlaneUnknown", mesh + "[material]\nE = 1\nnu = 0\nplane = 'stres'\n",
       "case.toml:5:9: material.plane: ", "unknown value \"stres\"",
       "did you mean \"stress\"? one of \"strain\", \"stress\""},
      {"BodyNotArray", head + "load.body = -9.81\n",
       "case.toml:3:13: load.body: ", "must be an array of 2 or 3, found the number -9.81", "per dimension"},
      {"BodyTooShort", head + "load.body = [1]\n", "case.toml:3:13: load.body: ", "found an array of 1",
       "per dimension"},
      {"BodyWithBool", head + "load.body = [0, true]\n",
       "case.toml:3:17: load.body[1]: ", "must be a number or a formula, found true", "such as"},
      {"BodyFormula", head + "load.body = [0, 'grav*y']\n",
       "case.toml:3:17: load.body[1]: ", "unknown name \"grav\" at character 1", "allowed are x, y, z"},
      {"DisplacementLength", head + "[boundary.a]\ndisplacement = [0, 0, 0, 0]\n",
       "case.toml:4:16: boundary.a.displacement: ", "found an array of 4", "\"free\" per dimension"},
      {"TractionDate", head + "[boundary.a]\ntraction = 2024-01-01\n",
       "case.toml:4:12: boundary.a.traction: ", "found a date or time", "per dimension"},
      {"PressureArray", head + "[boundary.a]\npressure = [1, 2]\n", "case.toml:4:12: boundary.a.pressure: ",
       "must be a number or a formula, found an array of 2", "such as"},
      {"PressureComma", head + "[boundary.a]\npressure = '1,5'\n",
       "case.toml:4:12: boundary.a.pressure: ", "has 2 results", "decimal sign"},
      {"Gamma0", head + "[nitsche]\ngamma0 = 0\n", "case.toml:4:10: nitsche.gamma0: ", "must be positive",
       "such as 10"},
      {"Stopping", head + "[newton]\nstopping = 'never'\n", "case.toml:4:12: newton.stopping: ",
       "unknown value \"never\"", "one of \"adaptive\", \"adaptive_local\", \"tolerance\""},
      {"GammaLin", head + "[newton]\ngamma_lin = -0.1\n",
       "case.toml:4:13: newton.gamma_lin: ", "must be positive, found -0.1", "0.1"},
      {"NewtonTolerance", head + "[newton]\ntolerance = 0\n",
       "case.toml:4:13: newton.tolerance: ", "must lie in (0, 1), found 0", "1e-10"},
      {"MaxSteps", head + "[newton]\nmax_steps = 0\n",
       "case.toml:4:13: newton.max_steps: ", "an integer of at least 1, found 0", "50"},
      {"AdaptTolerance", head + "[adapt]\ntolerance = -1\n",
       "case.toml:4:13: adapt.tolerance: ", "must be positive", "0.01"},
      {"ThetaZero", head + "[adapt]\ntheta = 0\n",
       "case.toml:4:9: adapt.theta: ", "must lie in (0, 1], found 0", "0.5"},
      {"ThetaLarge", head + "[adapt]\ntheta = 1.5\n", "case.toml:4:9: adapt.theta: ", "found 1.5", "0.5"},
      {"Marking", head + "[adapt]\nmarking = 'dorfler'\n",
       "case.toml:4:11: adapt.marking: ", "unknown value \"dorfler\"", "did you mean \"doerfler\"?"},
      {"MaxLevels", head + "[adapt]\nmax_levels = -1\n",
       "case.toml:4:14: adapt.max_levels: ", "an integer of at least 0, found -1", "given mesh"},
      {"MaxDofs", head + "[adapt]\nmax_dofs = 0\n", "case.toml:4:12: adapt.max_dofs: ", "found 0",
       "2_000_000"},
      {"MaxTime", head + "[adapt]\nmax_time = 0\n", "case.toml:4:12: adapt.max_time: ", "must be positive",
       "seconds"},
      {"MaxMemory", head + "[adapt]\nmax_memory = 0\n",
       "case.toml:4:14: adapt.max_memory: ", "must be positive", "GB"},
      {"ContactRule", head + "[certify]\ncontact_rule = 1\n", "case.toml:4:16: certify.contact_rule: ",
       "must be a string, found the integer 1", "one of \"resolved\", \"reference\""},
      {"SolverMethod", head + "[solver]\nmethod = 'lu'\n", "case.toml:4:10: solver.method: ",
       "unknown value \"lu\"", "one of \"auto\", \"direct\", \"condensed\", \"iterative\""},
      {"GammaAlg", head + "[solver]\ngamma_alg = 1\n",
       "case.toml:4:13: solver.gamma_alg: ", "must lie in [0, 1), found 1", "0.05"},
      {"SolverIterations", head + "[solver]\nmax_iterations = 1e3\n",
       "case.toml:4:18: solver.max_iterations: ", "must be an integer, found the number 1000", "500"},
      {"Vtu", head + "[output]\nvtu = 1\n",
       "case.toml:4:7: output.vtu: ", "must be true or false, found the integer 1", "without quotes"},
      {"Levels", head + "[output]\nlevels = 'first'\n",
       "case.toml:4:10: output.levels: ", "unknown value \"first\"", "one of \"last\", \"all\""},
      {"Report", head + "[output]\nreport = \"page.html\"\n",
       "case.toml:4:10: output.report: ", "must be true or false", "without quotes"},
      {"NoCharacter", head + "[output]\ndirectory = \"a\\u0000\"\n",
       "case.toml:4:13: output.directory: ", "holds the character \\u0000", "letters"},
      {"YoungAbsurd", mesh + "[material]\nE = 5e-324\nnu = 0\n",
       "case.toml:3:5: material.E: ", "must lie in [1e-60, 1e+60], found 5e-324", "units"},
      {"LoadAbsurd", head + "[boundary.a]\ntraction = [0, 1e300]\n",
       "case.toml:4:16: boundary.a.traction[1]: ", "is too large to compute with: 1e+300", "units"},
      {"LengthUnknown", head + "[units]\nlength = 'inch'\nforce = 'lbf'\n", "case.toml:4:10: units.length: ",
       "unknown value \"inch\"", "one of \"nm\", \"um\", \"mm\", \"cm\", \"in\", \"ft\", \"m\", \"km\""},
      {"LengthOtherwise", head + "[units]\nlength = 'MM'\nforce = 'N'\n",
       "case.toml:4:10: units.length: ", "unknown value \"MM\"", "one of \"nm\", \"um\", \"mm\""},
      {"ForceUnknown", head + "[units]\nlength = 'mm'\nforce = 'kg'\n",
       "case.toml:5:9: units.force: ", "unknown value \"kg\"", "did you mean \"kgf\"? one of \"nN\", \"uN\""},
      {"ForceNoName", head + "[units]\nlength = 'mm'\nforce = 1\n",
       "case.toml:5:9: units.force: ", "must be a string", "one of \"nN\", \"uN\""},
      {"StressIsDerived", head + "[units]\nlength = 'mm'\nforce = 'N'\nstress = 'MPa'\n",
       "case.toml:6:1: units.stress: ", "unknown key", "allowed here: length, force"},
      {"NoDirectory", head + "[output]\ndirectory = ''\n", "case.toml:4:13: output.directory: ", "is empty",
       "\"out\""},
  };
}

std::vector<BadCase> combinations()
{
  const std::string box = "mesh.box = {lower = [0, 0], upper = [2, 1], cells = [4, 2]}\n";
  return {
      {"NoMesh", material, "case.toml: mesh: ", "is missing", "[mesh] with file"},
      {"EmptyMesh", "[mesh]\n[material]\nE = 1\nnu = 0\n", "case.toml:1:1: mesh: ", "neither file nor box",
       "one of them"},
      {"FileAndBox", mesh + box + material, "case.toml:2:12: mesh.box: ", "box stands beside file",
       "one of them"},
      {"EmptyFile", "mesh.file = ''\n" + material, "case.toml:1:13: mesh.file: ", "is empty", "file = "},
      {"BoxWithoutCells", "mesh.box = {lower = [0, 0], upper = [2, 1]}\n" + material,
       "case.toml:1:12: mesh.box.cells: ", "is missing", "cells = [4, 2]"},
      {"BoxLengths", "mesh.box = {lower = [0, 0], upper = [2, 1, 1], cells = [4, 2]}\n" + material,
       "case.toml:1:12: mesh.box: ", "lower, upper and cells have 2, 3 and 2 numbers", "2 in 2D, 3 in 3D"},
      {"BoxFlat", "mesh.box = {lower = [0, 1], upper = [2, 1], cells = [4, 2]}\n" + material,
       "case.toml:1:12: mesh.box.upper: ", "upper[1] = 1 is not above lower[1] = 1", "opposite corners"},
      {"BoxNoCells", "mesh.box = {lower = [0, 0], upper = [2, 1], cells = [4, 0]}\n" + material,
       "case.toml:1:57: mesh.box.cells[1]: ", "an integer of at least 1, found 0", "number of cells"},
      {"BoxTooFine", "mesh.box = {lower = [0, 0], upper = [2, 1], cells = [99999999, 99999999]}\n" + material,
       "case.toml:1:12: mesh.box.cells: ", "makes 2e+16 simplices", "at most 1000000000000000"},
      {"NoForce", head + "[units]\nlength = 'mm'\n", "case.toml:3:1: units.force: ", "is missing",
       "length = \"mm\", force = \"N\"; stresses follow"},
      {"NoLength", head + "[units]\n", "case.toml:3:1: units.length: ", "is missing", "force = \"N\""},
      {"NoMaterial", mesh, "case.toml: material: ", "is missing", "[material] with E"},
      {"EmptyMaterial", mesh + "[material]\n", "case.toml:2:1: material.E: ", "is missing",
       "Young's modulus"},
      {"NoPoisson", mesh + "[material]\nE = 1\n", "case.toml:2:1: material.nu: ", "is missing", "nu = 0.3"},
      {"NoYoungInRegion", mesh + "[material.steel]\nnu = 0.3\n",
       "case.toml:2:1: material.steel.E: ", "is missing", "Young's modulus"},
      {"EmptyLoad", head + "[load.steel]\n", "case.toml:3:1: load.steel: ", "gives no load", "body = "},
      {"NoTemperature", head + "[load]\nbody = [0, 1]\nreference_temperature = 20\n",
       "case.toml:3:1: load.temperature: ", "is missing", "to be compared"},
      {"InitialStressTooShort", head + "load.initial_stress = [1, 2]\n",
       "case.toml:3:23: load.initial_stress: ", "an array of 3 or more", "[xx, yy, xy]"},
      {"ExpansionNotFinite", mesh + "material = {E = 1, nu = 0.3, alpha = inf}\n",
       "case.toml:2:38: material.alpha: ", "finite", "ordinary"},
      {"EmptyBoundary", head + "[boundary.top]\n", "case.toml:3:11: boundary.top: ",
       "nothing is given on this boundary", "traction-free is traction = [0, 0]"},
      {"ContactAndDisplacement", head + "[boundary.a]\ncontact = {}\ndisplacement = [0, 'free']\n",
       "case.toml:5:16: boundary.a.displacement: ", "stands beside contact", "split the group"},
      {"ContactAndPressure", head + "[boundary.a]\ncontact = {}\npressure = 1\n",
       "case.toml:5:12: boundary.a.pressure: ", "stands beside contact", "split the group"},
      {"SliderAndDisplacement", head + "[boundary.a]\nslider = 0\ndisplacement = [0, 'free']\n",
       "case.toml:5:16: boundary.a.displacement: ", "stands beside slider", "split the group"},
      {"ContactAndSlider", head + "[boundary.a]\ncontact = {}\nslider = 0\n",
       "case.toml:5:10: boundary.a.slider: ", "stands beside contact", "split the group"},
      {"NormalOfNoSlider", head + "[boundary.a]\nnormal = [0, 1]\n",
       "case.toml:4:10: boundary.a.normal: ", "belongs to a slider", "slider = 0"},
      {"SliderOfNoShape", head + "[boundary.a]\nslider = 0\nnormal = 'shape'\n",
       "case.toml:5:10: boundary.a.normal: ", "there is no such surface here", "name a shape"},
      {"SpringAndContact", head + "[boundary.a]\ncontact = {}\nspring = 1\n",
       "case.toml:5:10: boundary.a.spring: ", "stands beside contact", "split the group"},
      {"SpringOnFixed", head + "[boundary.a]\ndisplacement = [0, 0]\nspring = 1\n",
       "case.toml:5:10: boundary.a.spring: ", "has no effect", "\"free\""},
      {"SpringWithoutStiffness", head + "[boundary.a]\nspring = { rest = [0, 0] }\n",
       "case.toml:4:10: boundary.a.spring: ", "has no stiffness", "tangential = 1e6"},
      {"SpringInTime", head + "[boundary.a]\nspring = '1 - t'\n", "case.toml:4:10: boundary.a.spring: ",
       "the stiffness of a spring does not change", "the place of rest may move"},
      {"SpringNegative", head + "[boundary.a]\nspring = -1\n",
       "case.toml:4:10: boundary.a.spring: ", "must not be negative, found the integer -1", "0 or more"},
      {"SpringAsMatrix", head + "[boundary.a]\nspring = [[2, 1], [1, 2]]\n",
       "case.toml:4:10: boundary.a.spring: ", "must be one stiffness, or those along and across the normal",
       "tangential = 1e6"},
      {"ForceOnBoundary", head + "[boundary.a]\ntraction = [0, 1]\nforce = [0, 1]\n",
       "case.toml:5:1: boundary.a.force: ", "the displacement under it is infinite",
       "a patch of given radius"},
      {"ForceInLoad", head + "[load]\nbody = [0, 1]\nforce = [0, 1]\n",
       "case.toml:5:1: load.force: ", "a force needs an area", "traction = force / area"},
      {"PointLoads", head + "[[load.point]]\nat = [1, 2]\nforce = [0, 1]\n",
       "case.toml:3:8: load.point: ", "a force needs an area", "in 3D"},
      {"PointLoadTable", head + "[load.tip]\nat = [1, 2]\nforce = [0, 1]\n",
       "case.toml:5:1: load.tip.force: ", "a force needs an area", "a patch"},
      {"TopLevelPointLoad", head + "[[point_load]]\nat = [1, 2]\nforce = [0, 1]\n",
       "case.toml:3:3: point_load: ", "a force needs an area", "a patch"},
      {"RigidAndTraction", head + "[boundary.a]\nrigid = {}\ntraction = [0, 1]\n",
       "case.toml:5:12: boundary.a.traction: ", "stands beside rigid", "forces and moments in the table"},
      {"RigidMotionUnknown", head + "[boundary.a]\nrigid = { fixed = ['x', 'r'] }\n",
       "case.toml:4:25: boundary.a.rigid.fixed[1]: ", "unknown value \"r\"", "rz"},
      {"TractionOnFixed", head + "[boundary.a]\ndisplacement = [0, 'free']\ntraction = [1, 2]\n",
       "case.toml:5:13: boundary.a.traction[0]: ", "is not 0, but displacement fixes this component",
       "displacement[0] to \"free\""},
      {"TractionLength", head + "[boundary.a]\ndisplacement = [0, 'free']\ntraction = [0, 2, 0]\n",
       "case.toml:5:12: boundary.a.traction: ", "has 3 components, displacement has 2", "one per dimension"},
      {"PressureOnFixed", head + "[boundary.a]\ndisplacement = [0, 0]\npressure = 2\n",
       "case.toml:5:12: boundary.a.pressure: ", "has no effect", "\"free\""},
      {"FrictionUnknown", head + "[boundary.a]\ncontact = {friction = 'trseca'}\n",
       "case.toml:4:23: boundary.a.contact.friction: ", "unknown value \"trseca\"",
       "did you mean \"tresca\"?"},
      {"TrescaWithoutThreshold", head + "[boundary.a]\ncontact = {friction = 'tresca'}\n",
       "case.toml:4:11: boundary.a.contact.threshold: ", "is missing", "tangential stress"},
      {"CoulombWithoutCoefficient", head + "[boundary.a]\ncontact = {friction = 'coulomb'}\n",
       "case.toml:4:11: boundary.a.contact.coefficient: ", "is missing", "coefficient = 0.3"},
      {"CoulombWithThreshold",
       head + "[boundary.a]\ncontact = {friction = 'coulomb', coefficient = 0.3, threshold = 1}\n",
       "case.toml:4:65: boundary.a.contact.threshold: ", "does not belong to friction = \"coulomb\"",
       "\"tresca\""},
      {"ThresholdWithoutLaw", head + "[boundary.a]\ncontact = {threshold = 1}\n",
       "case.toml:4:24: boundary.a.contact.threshold: ", "does not belong to friction = \"none\"",
       "\"tresca\""},
      {"ContactIsOneTable", head + "[contact]\nslave = 'a'\n",
       "case.toml:3:1: contact: ", "must be an array of tables", "[[contact]]"},
      {"ContactWithoutSlave", head + "[[contact]]\nmaster = 'a'\n",
       "case.toml:3:1: contact[0].slave: ", "is missing", "joint"},
      {"ContactWithoutMaster", head + "[[contact]]\nslave = 'a'\n",
       "case.toml:3:1: contact[0].master: ", "is missing", "joint"},
      {"ContactOfNoBoundary", head + "[[contact]]\nslave = []\nmaster = 'a'\n",
       "case.toml:4:9: contact[0].slave: ", "is empty", "boundary of the mesh"},
      {"ContactOfANumber", head + "[[contact]]\nslave = 3\nmaster = 'a'\n",
       "case.toml:4:9: contact[0].slave: ", "must be a string or an array", "boundary of the mesh"},
      {"SlaveIsMaster", head + "[[contact]]\nslave = ['a', 'b']\nmaster = 'b'\n",
       "case.toml:5:10: contact[0].master: ", "\"b\" is the slave, too", "two boundaries"},
      {"JointWithSlave", head + "[[contact]]\njoint = 'a'\nslave = 'b'\n",
       "case.toml:5:9: contact[0].slave: ", "stands beside joint", "makes both sides itself"},
      {"TiedWithGap", head + "[[contact]]\njoint = 'a'\nfriction = 'tied'\ngap = 0\n",
       "case.toml:6:7: contact[0].gap: ", "does not belong to friction = \"tied\"", "move together"},
      {"TiedWithCoefficient", head + "[[contact]]\njoint = 'a'\nfriction = 'tied'\ncoefficient = 0\n",
       "case.toml:6:15: contact[0].coefficient: ", "does not belong to friction = \"tied\"", "coulomb"},
      {"TiedObstacle", head + "[boundary.a]\ncontact = {friction = 'tied'}\n",
       "case.toml:4:23: boundary.a.contact.friction: ", "tied", "none"},
      {"PairingByAWord", head + "[[contact]]\njoint = 'a'\npairing = 'nearest'\n",
       "case.toml:5:11: contact[0].pairing: ", "is \"nearest\"", "normal"},
      {"PairingWithoutLength", head + "[[contact]]\njoint = 'a'\npairing = [0, 0]\n",
       "case.toml:5:11: contact[0].pairing: ", "has no length", "direction"},
      {"ReachNegative", head + "[[contact]]\njoint = 'a'\nreach = -1\n",
       "case.toml:5:9: contact[0].reach: ", "must be positive", "largest distance"},
      {"ContactKeyUnknown", head + "[[contact]]\njoint = 'a'\nreech = 1\n",
       "case.toml:5:1: contact[0].reech: ", "unknown key", "reach"},
      {"BoxesBesideFile", "mesh = {file = 'a.msh', boxes = {}}\n" + material,
       "case.toml:1:33: mesh.boxes: ", "boxes stands beside file", "one of them"},
      {"BoxesEmpty", "mesh.boxes = {}\n" + material, "case.toml:1:14: mesh.boxes: ", "is empty",
       "one box for each body"},
      {"BoxesOfTwoDimensions",
       "mesh.boxes.a = {lower = [0, 0], upper = [1, 1], cells = [1, 1]}\n"
       "mesh.boxes.b = {lower = [0, 0, 0], upper = [1, 1, 1], cells = [1, 1, 1]}\n" +
           material,
       "case.toml:2:12: mesh.boxes.b: ", "another dimension", "all 2D or all 3D"},
      {"ThresholdNegative", head + "[boundary.a]\ncontact = {friction = 'tresca', threshold = -1}\n",
       "case.toml:4:45: boundary.a.contact.threshold: ", "must not be negative, found the integer -1",
       "max(0"},
      {"ThresholdFormulaNegative",
       head + "[boundary.a]\ncontact = {friction = 'tresca', threshold = '1 - 2'}\n",
       "case.toml:4:45: boundary.a.contact.threshold: ", "must not be negative, found the string \"1 - 2\"",
       "max(0"},
      {"CoefficientNegative", head + "[boundary.a]\ncontact = {friction = 'coulomb', coefficient = -0.1}\n",
       "case.toml:4:48: boundary.a.contact.coefficient: ", "must not be negative, found -0.1", "0.3"},
      {"ContactNotATable", head + "[boundary.a]\ncontact = true\n",
       "case.toml:4:11: boundary.a.contact: ", "must be a table, found true", "friction, threshold"},
  };
}

std::string name_of(const testing::TestParamInfo<BadCase>& info)
{
  return info.param.name;
}

/// toml++ recurses on both forms.
TEST(DeepDocument, IsRefusedBeforeItIsParsed)
{
  std::string key = "a";
  for (int i = 1; i < 20000; ++i) key += i == 15000 ? "\n= 1\n[b" : ".a";
  const std::vector<std::string> texts = {"x = 1\n" + key + " = 1\n",
                                          "x = 1\ny = " + std::string(100000, '['),
                                          "x = 1\ny = " + std::string(100000, '{')};
  for (const std::string& text : texts) try
    {
      (void)case_file::parse_config(text, "case.toml");
      FAIL() << "accepted";
    }
    catch (const InputError& error)
    {
      EXPECT_THAT(error.what(), AllOf(StartsWith("case.toml:2:"), HasSubstr("nested more than 20 deep")));
    }
  const std::string harmless =
      "title = \"[[[[[[[[[[[[[[[[[[[[[[ \\\" .......................\" # {{{{{{{{{{{{{{{{{{{{{{{\n";
  EXPECT_EQ(case_file::parse_config(harmless + head, "case.toml").title.size(), 48u);
}

INSTANTIATE_TEST_SUITE_P(Syntax, BadCaseFile, testing::ValuesIn(syntax()), name_of);
INSTANTIATE_TEST_SUITE_P(Values, BadCaseFile, testing::ValuesIn(values()), name_of);
INSTANTIATE_TEST_SUITE_P(Combinations, BadCaseFile, testing::ValuesIn(combinations()), name_of);

}  // namespace
}  // namespace tribound

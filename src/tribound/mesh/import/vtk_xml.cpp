#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <pugixml.hpp>
#include <utility>

#include "tribound/mesh/import/file_text.h"
#include "tribound/mesh/import/text_lines.h"
#include "tribound/mesh/import/vtk_file.h"

namespace tribound::mesh
{

namespace
{

constexpr std::array<std::pair<std::string_view, VtkType>, 10> xml_types = {{{"Int8", VtkType::int8},
                                                                             {"UInt8", VtkType::uint8},
                                                                             {"Int16", VtkType::int16},
                                                                             {"UInt16", VtkType::uint16},
                                                                             {"Int32", VtkType::int32},
                                                                             {"UInt32", VtkType::uint32},
                                                                             {"Int64", VtkType::int64},
                                                                             {"UInt64", VtkType::uint64},
                                                                             {"Float32", VtkType::float32},
                                                                             {"Float64", VtkType::float64}}};

class VtkXml
{
 public:
  VtkXml(const std::filesystem::path& path, VtkFile& file)
      : path_(path), where_{.file = path.string()}, file_(file)
  {
    file.contents.push_back(std::make_unique<std::string>(
        content_of(path, where_, "the parts of a .pvtu are where it says, relative to it")));
    content_ = file.contents.back().get();
  }

  void read(bool may_have_parts);

 private:
  [[noreturn]] void fail(const std::string& problem, const std::string& hint = {}) const
  {
    throw InputError(where_, problem, hint);
  }
  void find_appended();
  void parse();
  void read_header(const pugi::xml_node& root);
  void read_piece(const pugi::xml_node& node);
  void read_parts(const pugi::xml_node& grid);
  [[nodiscard]] std::size_t count(const pugi::xml_node& node, const char* attribute) const;
  [[nodiscard]] static std::vector<std::string> component_names_of(const pugi::xml_node& node, std::size_t n);
  [[nodiscard]] VtkArray array_of(const pugi::xml_node& node) const;
  [[nodiscard]] std::vector<VtkArray> arrays_of(const pugi::xml_node& node) const;
  [[nodiscard]] VtkArray required(const pugi::xml_node& node, const std::string& name) const;

  const std::filesystem::path& path_;
  Where where_;
  VtkFile& file_;
  std::string* content_;
  std::size_t xml_size_ = 0;
  std::string_view appended_{};
  VtkCoding::Format appended_format_ = VtkCoding::Format::raw;
  pugi::xml_document document_{};
  VtkCoding coding_{};
  bool has_old_hexahedra_ = false;
};

/// Appended bytes are no XML: what comes before them is closed in their place.
void VtkXml::find_appended()
{
  constexpr std::string_view tag = "<AppendedData";
  constexpr std::string_view end = "</VTKFile>";
  xml_size_ = content_->size();
  const std::size_t begin = content_->find(tag);
  if (begin == std::string::npos) return;
  const std::size_t begin_of_data = content_->find('_', begin);
  const std::string_view head = std::string_view(*content_).substr(begin, begin_of_data - begin);
  const bool is_base64 = head.find("\"base64\"") != std::string_view::npos;
  if (begin_of_data == std::string::npos || (!is_base64 && head.find("\"raw\"") == std::string_view::npos))
    fail("the appended data have neither the encoding \"raw\" nor \"base64\"", "write the file again");
  appended_ = std::string_view(*content_).substr(begin_of_data + 1);
  if (is_base64)
  {
    appended_format_ = VtkCoding::Format::base64;
    appended_ = appended_.substr(0, appended_.find('<'));
  }
  content_->replace(begin, end.size(), end);  // of no greater length: what is appended stays
  xml_size_ = begin + end.size();
}

void VtkXml::parse()
{
  // XML is parsed where it is: texts of arrays stay in the content.
  const pugi::xml_parse_result result =
      document_.load_buffer_inplace(content_->data(), xml_size_, pugi::parse_default, pugi::encoding_utf8);
  if (result) return;
  const std::string original = content_of(path_, where_, {});
  const auto until = original.begin() + std::min<std::ptrdiff_t>(result.offset, std::ssize(original));
  where_.line = static_cast<int>(std::count(original.begin(), until, '\n')) + 1;
  fail(fmt::format("is no XML: {}", result.description()),
       "a .vtu of VTK, ParaView, meshio, MFEM, deal.II, DOLFINx; is it cut off?");
}

void VtkXml::read_header(const pugi::xml_node& root)
{
  const std::string_view compressor = root.attribute("compressor").value();
  if (!compressor.empty() && compressor != "vtkZLibDataCompressor")
    fail(fmt::format("is compressed by {}", compressor),
         "zlib (vtkZLibDataCompressor) is read: choose it where the file is written, or no compression");
  const std::string_view order = root.attribute("byte_order").value();
  if (!order.empty() && order != "LittleEndian" && order != "BigEndian")
    fail(fmt::format("has the byte order \"{}\"", order), "LittleEndian or BigEndian");
  const std::string_view header = root.attribute("header_type").value();
  if (!header.empty() && header != "UInt32" && header != "UInt64")
    fail(fmt::format("has the header type \"{}\"", header), "UInt32 or UInt64");
  coding_.header_size = header == "UInt64" ? 8 : 4;
  coding_.is_swapped = (order == "BigEndian") == (std::endian::native == std::endian::little);
  coding_.is_compressed = !compressor.empty();
  // As VTK 9 has it: hexahedra of order 2 were changed with version 2.1 of the format.
  has_old_hexahedra_ = root.attribute("version").as_double(0.1) < 2.1;
}

std::size_t VtkXml::count(const pugi::xml_node& node, const char* attribute) const
{
  const std::string_view text = trimmed(node.attribute(attribute).value());  // FreeFEM: " 12"
  const auto number = integer_of(text);
  if (!number || *number < 0 || *number > std::ssize(*content_) * 1032)
    fail(fmt::format("{} of a <Piece> is \"{}\"", attribute, text.substr(0, 40)),
         "a number, of points or cells that the file has");
  return static_cast<std::size_t>(*number);
}

std::vector<std::string> VtkXml::component_names_of(const pugi::xml_node& node, std::size_t n)
{
  std::vector<std::string> names;
  while (names.size() < n)
  {
    const auto name = node.attribute(fmt::format("ComponentName{}", names.size()).c_str());
    if (!name) return {};
    names.emplace_back(name.value());
  }
  return names;
}

VtkArray VtkXml::array_of(const pugi::xml_node& node) const
{
  VtkArray array{.name = node.attribute("Name").value(), .coding = coding_};
  const auto known = std::ranges::find(xml_types, std::string_view(node.attribute("type").value()),
                                       &std::pair<std::string_view, VtkType>::first);
  if (known != xml_types.end()) array.type = known->second;
  array.n_components = std::max(1U, node.attribute("NumberOfComponents").as_uint(1));
  array.component_names = component_names_of(node, array.n_components);
  const std::string_view format = node.attribute("format").value();
  if (format == "appended")
  {
    const auto offset = integer_of(node.attribute("offset").value());
    if (!offset || *offset < 0 || *offset > std::ssize(appended_))
      fail(fmt::format("array \"{}\" begins beyond the appended data", array.name), "is the file cut off?");
    array.coding.format = appended_format_;
    array.data = appended_.substr(*offset);
    return array;
  }
  if (format != "binary" && format != "ascii" && !format.empty())
    fail(fmt::format("array \"{}\" has the format \"{}\"", array.name, format), "ascii, binary or appended");
  array.coding.format = format == "binary" ? VtkCoding::Format::base64 : VtkCoding::Format::text;
  array.data = node.child_value();
  return array;
}

std::vector<VtkArray> VtkXml::arrays_of(const pugi::xml_node& node) const
{
  std::vector<VtkArray> arrays;
  for (const pugi::xml_node& child : node.children("DataArray")) arrays.push_back(array_of(child));
  return arrays;
}

VtkArray VtkXml::required(const pugi::xml_node& node, const std::string& name) const
{
  const pugi::xml_node child = node.find_child_by_attribute("DataArray", "Name", name.c_str());
  if (!child) fail(fmt::format("a <Piece> has no array \"{}\" of its cells", name), "is the file cut off?");
  return array_of(child);
}

void VtkXml::read_piece(const pugi::xml_node& node)
{
  VtkPiece piece{.where = where_,
                 .n_points = count(node, "NumberOfPoints"),
                 .n_cells = count(node, "NumberOfCells"),
                 .has_old_hexahedra = has_old_hexahedra_};
  if (piece.n_cells == 0) return;
  piece.points = array_of(node.child("Points").child("DataArray"));
  if (piece.points.name.empty()) piece.points.name = "Points";
  const pugi::xml_node cells = node.child("Cells");
  piece.types = required(cells, "types");
  piece.connectivity = required(cells, "connectivity");
  piece.offsets = required(cells, "offsets");
  if (!is_integer(piece.offsets.type)) fail("the offsets of the cells are no integers");
  piece.point_data = arrays_of(node.child("PointData"));
  piece.cell_data = arrays_of(node.child("CellData"));
  file_.pieces.push_back(std::move(piece));
}

void VtkXml::read_parts(const pugi::xml_node& grid)
{
  for (const pugi::xml_node& part : grid.children("Piece"))
    VtkXml(path_.parent_path() / part.attribute("Source").value(), file_).read(false);
}

void VtkXml::read(bool may_have_parts)
{
  find_appended();
  parse();
  const pugi::xml_node root = document_.child("VTKFile");
  const std::string_view type = root.attribute("type").value();
  read_header(root);
  if (type == "PUnstructuredGrid" && may_have_parts) return read_parts(root.child("PUnstructuredGrid"));
  if (type != "UnstructuredGrid")
    fail(
        fmt::format("is {}{}, not an unstructured grid", type.empty() ? "no VTK file" : "of the type ", type),
        "unstructured grids (.vtu) are read; ParaView's filter Append Datasets makes one of other grids");
  for (const pugi::xml_node& piece : root.child("UnstructuredGrid").children("Piece")) read_piece(piece);
}

}  // namespace

void open_vtk_xml(const std::filesystem::path& path, VtkFile& file)
{
  VtkXml(path, file).read(true);
}

}  // namespace tribound::mesh

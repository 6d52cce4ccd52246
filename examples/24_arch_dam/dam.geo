// An arch dam of double curvature in a valley of rock: 8 monoliths between 7 radial contraction joints. x points downstream, y across the valley, z up.
// Arches are parabolas x = X(z) + y^2/(2 R), their faces go by radial lines: the normals of the upstream arch of the crest at the joints. The base of every
// monolith is plane; where two of them meet, they share the line of the joint. Dam, monoliths and rock share no point, and their meshes do not match.

height = 100;          // m
crest = 7;             // thickness of the crown cantilever at crest
base = 28;             // and at the base
bulge = 6;             // of its upstream face at half height
r_up = 105;            // radius of the upstream arches at the crown
r_down = 92;           // of the downstream ones: arches become thicker towards the abutments
spacing = 22.5;        // of the joints across the valley
valley[] = {0, 8, 24, 44, 66};  // height of the rock at the joints, from the crown to the abutment
upstream = 50;         // m of rock upstream of the crest
downstream = 70;       // and downstream
aside = 50;            // beside the abutments
depth = 60;            // below the crown
If (!Exists(h))
  h = 16;              // mesh size; full.geo has another one
EndIf
h_rock = 1.7*h;        // of the rock where the dam stands
h_far = 60;

// Joints k = 0 to 8, 0 and 8 at the abutments, 4 at the crown: a point of the line of the base and the direction downstream, which falls by slope[k].
For k In {0:8}
  y[k] = spacing*(k - 4);
  x[k] = y[k]^2/(2*r_up);
  z[k] = valley[Fabs(k - 4)];
  nx[k] = 1/Sqrt(1 + (y[k]/r_up)^2);
  ny[k] = -y[k]/r_up*nx[k];
EndFor
slope[4] = 0;
For j In {1:4}         // the plane base from the joint k - 1 to the joint k: z grows by a and b
  k = 4 + j;
  det = nx[k - 1]*(y[k] - y[k - 1]) - ny[k - 1]*(x[k] - x[k - 1]);
  a = (slope[k - 1]*(y[k] - y[k - 1]) - ny[k - 1]*(z[k] - z[k - 1]))/det;
  b = (nx[k - 1]*(z[k] - z[k - 1]) - slope[k - 1]*(x[k] - x[k - 1]))/det;
  slope[k] = a*nx[k] + b*ny[k];
  slope[4 - j] = slope[k];
EndFor

// s[]: distance along the radial line of joint k at height zz of the upstream (side = 0) and the downstream face (side = 1).
Macro Faces
  xx = -4*bulge*zz/height*(1 - zz/height) + (side ? crest + (base - crest)*(1 - zz/height) : 0);
  r = side ? r_down : r_up;
  p = nx[k]*r - ny[k]*y[k];        // ny^2 s^2 - 2 p s + q = 0, and the smaller root
  q = y[k]^2 - 2*r*(x[k] - xx);
  s = q/(p + Sqrt(p^2 - ny[k]^2*q));
Return
// The same where the face meets the line of the base.
Macro Foot
  s = 0;
  For iteration In {1:40}
    zz = z[k] + slope[k]*s;
    Call Faces;
  EndFor
  zz = z[k] + slope[k]*s;
Return
For k In {0:8}
  side = 0;
  Call Foot;
  heel[k] = s;
  side = 1;
  Call Foot;
  toe[k] = s;
EndFor

// The profile of one face on one joint: a spline, at the abutments a line. The points of its ends are foot and top, the curve is profile.
levels = 4;
Macro Profile
  s = side ? toe[k] : heel[k];
  z_foot = z[k] + slope[k]*s;
  foot = newp;
  Point(foot) = {x[k] + s*nx[k], y[k] + s*ny[k], z_foot, size};
  ends[] = {foot};
  If (k > 0 && k < 8)
    For level In {1:levels - 1}
      zz = z_foot + (height - z_foot)*level/levels;
      Call Faces;
      middle = newp;
      Point(middle) = {x[k] + s*nx[k], y[k] + s*ny[k], zz, size};
      ends[] += {middle};
    EndFor
  EndIf
  zz = height;
  Call Faces;
  top = newp;
  Point(top) = {x[k] + s*nx[k], y[k] + s*ny[k], zz, size};
  ends[] += {top};
  profile = newl;
  Spline(profile) = ends[];
Return

// The monoliths, m = 1 to 8 between the joints m - 1 and m.
concrete[] = {};
up[] = {};
down[] = {};
crown[] = {};
For m In {1:8}
  size = h;
  across_n = Max(1, Round(0.5*base/h));                          // cells through the thickness,
  along_n = Max(1, Round(1.1*spacing/h));                        // along the arch
  up_n = Max(1, Round((height - (z[m - 1] + z[m])/2)/h)) + (m > 4); // and upwards: other ones than in the neighbours
  For e In {0:1}
    k = m - 1 + e;
    For side In {0:1}
      Call Profile;
      feet[2*e + side] = foot;
      tops[2*e + side] = top;
      profiles[2*e + side] = profile;
    EndFor
    low[e] = newl;
    Line(low[e]) = {feet[2*e], feet[2*e + 1]};
    high[e] = newl;
    Line(high[e]) = {tops[2*e], tops[2*e + 1]};
    loop = newll;
    Curve Loop(loop) = {low[e], profiles[2*e + 1], -high[e], -profiles[2*e]};
    joint[e] = news;
    Plane Surface(joint[e]) = {loop};
  EndFor
  For side In {0:1}
    arch[] = {tops[side]};
    For part In {1:3}
      yy = y[m - 1] + spacing*part/4;
      middle = newp;
      If (side)
        // between the radial lines the downstream arch of the crest goes from end to end of its own parabola
        a_end[] = Point{tops[1]};
        b_end[] = Point{tops[3]};
        yy = a_end[1] + (b_end[1] - a_end[1])*part/4;
      EndIf
      Point(middle) = {(side ? crest : 0) + yy^2/(2*(side ? r_down : r_up)), yy, height, size};
      arch[] += {middle};
    EndFor
    arch[] += {tops[2 + side]};
    arc[side] = newl;
    Spline(arc[side]) = arch[];
    chord[side] = newl;
    Line(chord[side]) = {feet[side], feet[2 + side]};
    loop = newll;
    Curve Loop(loop) = {chord[side], profiles[2 + side], -arc[side], -profiles[side]};
    face[side] = news;
    Surface(face[side]) = {loop};
  EndFor
  loop = newll;
  Curve Loop(loop) = {chord[0], low[1], -chord[1], -low[0]};
  bottom = news;
  Plane Surface(bottom) = {loop};
  loop = newll;
  Curve Loop(loop) = {arc[0], high[1], -arc[1], -high[0]};
  roof = news;
  Plane Surface(roof) = {loop};
  loop = newsl;
  Surface Loop(loop) = {bottom, roof, face[0], face[1], joint[0], joint[1]};
  body = newv;
  Volume(body) = {loop};
  Transfinite Curve {low[], high[]} = across_n + 1;
  Transfinite Curve {chord[], arc[]} = along_n + 1;
  Transfinite Curve {profiles[]} = up_n + 1;
  Transfinite Surface {bottom, roof, face[], joint[]};
  Transfinite Volume {body};
  concrete[] += {body};
  up[] += {face[0]};
  down[] += {face[1]};
  crown[] += {roof};
  Physical Surface(Sprintf("base_%g", m)) = {bottom};
  If (m == 1)
    Physical Surface("end_1") = {joint[0]};
  Else
    Physical Surface(Sprintf("joint_%g_right", m - 1)) = {joint[0]};
  EndIf
  If (m == 8)
    Physical Surface("end_8") = {joint[1]};
  Else
    Physical Surface(Sprintf("joint_%g", m)) = {joint[1]};
  EndIf
EndFor
Physical Volume("concrete") = concrete[];
Physical Surface("upstream") = up[];
Physical Surface("downstream") = down[];
Physical Surface("crest") = crown[];

// The rock: sectors between the radial lines, from far upstream (0) by heel (1) and toe (2) to far downstream (3).
For k In {0:8}
  For i In {0:3}
    s = i == 0 ? -upstream : i == 1 ? heel[k] : i == 2 ? toe[k] : downstream;
    zz = z[k] + slope[k]*(i < 2 ? heel[k] : toe[k]);
    size = i == 0 || i == 3 ? h_far : h_rock;
    top_point[4*k + i] = newp;
    Point(top_point[4*k + i]) = {x[k] + s*nx[k], y[k] + s*ny[k], zz, size};
    If (i == 0 || i == 3)
      deep_point[4*k + i] = newp;
      Point(deep_point[4*k + i]) = {x[k] + s*nx[k], y[k] + s*ny[k], -depth, h_far};
      upright[4*k + i] = newl;
      Line(upright[4*k + i]) = {deep_point[4*k + i], top_point[4*k + i]};
    EndIf
  EndFor
  For i In {0:2}
    radial[4*k + i] = newl;
    Line(radial[4*k + i]) = {top_point[4*k + i], top_point[4*k + i + 1]};
  EndFor
EndFor
ground[] = {};
wet[] = {};
dry[] = {};
far[] = {};
For k In {0:7}
  For i In {0:3}
    across[4*k + i] = newl;
    Line(across[4*k + i]) = {top_point[4*k + i], top_point[4*k + 4 + i]};
  EndFor
  For i In {0:2}
    loop = newll;
    Curve Loop(loop) = {across[4*k + i], radial[4*k + 4 + i], -across[4*k + i + 1], -radial[4*k + i]};
    patch[i] = news;
    If (i == 1)
      Plane Surface(patch[i]) = {loop};
    Else
      Surface(patch[i]) = {loop};
    EndIf
  EndFor
  wet[] += {patch[0]};
  ground[] += {patch[1]};
  Physical Surface(Sprintf("foundation_%g", k + 1)) = {patch[1]};
  dry[] += {patch[2]};
  For i In {0:3:3}
    deep[4*k + i] = newl;
    Line(deep[4*k + i]) = {deep_point[4*k + i], deep_point[4*k + 4 + i]};
    loop = newll;
    Curve Loop(loop) = {deep[4*k + i], upright[4*k + 4 + i], -across[4*k + i], -upright[4*k + i]};
    wall = news;
    Plane Surface(wall) = {loop};
    far[] += {wall};
  EndFor
EndFor

// The abutments: a riser in the plane of the last joint, level ground at the height of the crest and the rock beside them.
For e In {0:1}
  k = 8*e;
  sign = 2*e - 1;
  tx = -sign*ny[k];    // away from the dam
  ty = sign*nx[k];
  For i In {0:3}
    side = i == 2;
    zz = height;
    Call Faces;
    s = i == 0 ? -upstream : i == 3 ? downstream : s;
    rim[i] = newp;
    Point(rim[i]) = {x[k] + s*nx[k], y[k] + s*ny[k], height, i == 0 || i == 3 ? h_far : h_rock};
    riser[i] = newl;
    Line(riser[i]) = {top_point[4*k + i], rim[i]};
    If (i == 0 || i == 3)
      outer[i] = newp;
      Point(outer[i]) = {x[k] + s*nx[k] + aside*tx, y[k] + s*ny[k] + aside*ty, height, h_far};
      under[i] = newp;
      Point(under[i]) = {x[k] + s*nx[k] + aside*tx, y[k] + s*ny[k] + aside*ty, -depth, h_far};
      plumb[i] = newl;
      Line(plumb[i]) = {under[i], outer[i]};
      level_line[i] = newl;
      Line(level_line[i]) = {rim[i], outer[i]};
      low_line[i] = newl;
      Line(low_line[i]) = {deep_point[4*k + i], under[i]};
      loop = newll;
      Curve Loop(loop) = {low_line[i], plumb[i], -level_line[i], -riser[i], -upright[4*k + i]};
      wall = news;
      Plane Surface(wall) = {loop};
      far[] += {wall};
    EndIf
  EndFor
  For i In {0:2}
    edge[i] = newl;
    Line(edge[i]) = {rim[i], rim[i + 1]};
    loop = newll;
    Curve Loop(loop) = {radial[4*k + i], riser[i + 1], -edge[i], -riser[i]};
    patch[i] = news;
    Plane Surface(patch[i]) = {loop};
  EndFor
  wet[] += {patch[0]};
  dry[] += {patch[2]};
  abutment[e] = patch[1];
  back = newl;
  Line(back) = {outer[0], outer[3]};
  loop = newll;
  Curve Loop(loop) = {edge[0], edge[1], edge[2], level_line[3], -back, -level_line[0]};
  plateau = news;
  Plane Surface(plateau) = {loop};
  dry[] += {plateau};
  back_low = newl;
  Line(back_low) = {under[0], under[3]};
  loop = newll;
  Curve Loop(loop) = {back_low, plumb[3], -back, -plumb[0]};
  wall = news;
  Plane Surface(wall) = {loop};
  far[] += {wall};
  If (e == 0)
    ends_0[] = {low_line[0], low_line[3], back_low};
  Else
    ends_1[] = {low_line[0], low_line[3], back_low};
  EndIf
EndFor
bottom_loop[] = {};
For k In {0:7}
  bottom_loop[] += {deep[4*k]};
EndFor
bottom_loop[] += {ends_1[0], ends_1[2], -ends_1[1]};
For k In {0:7}
  bottom_loop[] += {-deep[4*(7 - k) + 3]};
EndFor
bottom_loop[] += {ends_0[1], -ends_0[2], -ends_0[0]};
loop = newll;
Curve Loop(loop) = bottom_loop[];
floor = news;
Plane Surface(floor) = {loop};
far[] += {floor};
loop = newsl;
Surface Loop(loop) = {ground[], wet[], dry[], far[], abutment[]};
rock = newv;
Volume(rock) = {loop};
Physical Volume("rock") = {rock};
Physical Surface("abutment_1") = {abutment[0]};
Physical Surface("abutment_8") = {abutment[1]};
Physical Surface("reservoir") = wet[];
Physical Surface("valley") = dry[];
Physical Surface("far") = far[];

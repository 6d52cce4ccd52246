// A quarter of two plates with a bolt through them, lengths in mm: x >= 0, y >= 0, the bolt along z. The plates lie on
// either side of z = 0; head and nut touch them in rings. The three bodies share no point.
SetFactory("OpenCASCADE");

thickness = 10;   // of each plate
length = 30;      // of the quarter of a plate, along x
width = 20;
hole = 5.5;       // radii: of the hole, of the shank, of head and nut, and inside of their contact rings
shank = 5;
head = 9;
ring = 6;
groove = 1;       // inside of that, so that head and nut touch nothing but the plates
height = 6;       // of head and nut
h_plate = 5;      // mesh sizes: the run refines where it must
h_bolt = 3;
e = 1e-3;

Macro Plate       // from z = base upwards, but for the hole
  v = newv;
  Box(v) = {0, 0, base, length, width, thickness};
  Cylinder(v + 1) = {0, 0, base, 0, 0, thickness, hole};
  plate[] = BooleanDifference{ Volume{v}; Delete; }{ Volume{v + 1}; Delete; };
  below[] = Surface In BoundingBox {-e, -e, base - e, length + e, width + e, base + e};
  above[] = Surface In BoundingBox {-e, -e, base + thickness - e, length + e, width + e, base + thickness + e};
Return

base = 0;
Call Plate;
Physical Volume("upper") = {plate[0]};
Physical Surface("upper.bottom") = {below[]};
Physical Surface("upper.top") = {above[]};
volumes[] = {plate[0]};
Physical Surface("pulled") = Surface In BoundingBox {length - e, -e, base - e, length + e, width + e, base + thickness + e};

base = -thickness;
interface[] = below[];
Call Plate;
above[] -= interface[];
Physical Volume("lower") = {plate[0]};
Physical Surface("lower.bottom") = {below[]};
Physical Surface("lower.top") = {above[]};
Physical Surface("held") = Surface In BoundingBox {length - e, -e, base - e, length + e, width + e, base + thickness + e};
volumes[] += {plate[0]};

// The bolt: its section, turned.
end = thickness + height;
p = newp;
Point(p) = {0, 0, -end};
Point(p + 1) = {head, 0, -end};
Point(p + 2) = {head, 0, -thickness};
Point(p + 3) = {ring, 0, -thickness};
Point(p + 4) = {ring, 0, -thickness - groove};
Point(p + 5) = {shank, 0, -thickness - groove};
Point(p + 6) = {shank, 0, thickness + groove};
Point(p + 7) = {ring, 0, thickness + groove};
Point(p + 8) = {ring, 0, thickness};
Point(p + 9) = {head, 0, thickness};
Point(p + 10) = {head, 0, end};
Point(p + 11) = {0, 0, end};
l = newl;
For i In {0 : 10}
  Line(l + i) = {p + i, p + i + 1};
EndFor
Line(l + 11) = {p + 11, p};
Curve Loop(l + 12) = {l : l + 11};
s = news;
Plane Surface(s) = {l + 12};
bolt[] = Extrude { {0, 0, 1}, {0, 0, 0}, Pi/2 } { Surface{s}; };
Physical Volume("bolt") = {bolt[1]};
Physical Surface("head") = Surface In BoundingBox {-e, -e, thickness - e, head + e, head + e, thickness + e};
Physical Surface("nut") = Surface In BoundingBox {-e, -e, -thickness - e, head + e, head + e, -thickness + e};

Physical Surface("symmetry_x") = Surface In BoundingBox {-e, -e, -end - e, e, width + e, end + e};
Physical Surface("symmetry_y") = Surface In BoundingBox {-e, -e, -end - e, length + e, e, end + e};

MeshSize { PointsOf { Volume{volumes[]}; } } = h_plate;
MeshSize { PointsOf { Volume{bolt[1]}; } } = h_bolt;

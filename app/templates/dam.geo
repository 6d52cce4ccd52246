// Section of a gravity dam: upright at the water (x = 0), sloping on the other side. Metres.

height = 30;
crest = 4;
base = 24;
h = 3;         // mesh size; adaptation goes on from there

Point(1) = {0, 0, 0, h};
Point(2) = {base, 0, 0, h};
Point(3) = {crest, height, 0, h};
Point(4) = {0, height, 0, h};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};

Physical Surface("concrete") = {1};
Physical Curve("base") = {1};
Physical Curve("downstream") = {2};
Physical Curve("crest") = {3};
Physical Curve("upstream") = {4};

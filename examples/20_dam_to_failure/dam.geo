// Section of a concrete gravity dam: vertical upstream face, inclined downstream face. The base is y = 0.

height = 80;      // m
base = 60;
crest = 5;
h = 5;            // mesh size: the path is followed again where it must be finer

Point(1) = {0, 0, 0, h};          // heel
Point(2) = {base, 0, 0, h};       // toe
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

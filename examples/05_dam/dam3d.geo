// A monolith of the dam, 15 m between two contraction joints: the section of dam.geo drawn out along z.

height = 50;      // m
crest = 5;        // m
slope = 0.8;      // of the downstream face, horizontal : vertical
length = 15;      // m
h = 10;           // mesh size: the run refines where it must

Point(1) = {0, 0, 0, h};                        // heel
Point(2) = {crest + slope*height, 0, 0, h};     // toe
Point(3) = {crest, height, 0, h};
Point(4) = {0, height, 0, h};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
drawn[] = Extrude {0, 0, length} { Surface{1}; };   // the far end, the volume, then a face per line

Physical Volume("concrete") = {drawn[1]};
Physical Surface("ends") = {1, drawn[0]};
Physical Surface("base") = {drawn[2]};
Physical Surface("downstream") = {drawn[3]};
Physical Surface("crest") = {drawn[4]};
Physical Surface("upstream") = {drawn[5]};

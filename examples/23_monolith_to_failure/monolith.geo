// Monolith of a concrete gravity dam between two contraction joints: the section of example 20, x downstream, z upwards, along the axis y.

height = 80;      // m
base = 60;
crest = 5;
width = 6;        // of the monolith
h = 6;            // mesh size at the base
h_top = 20;

Point(1) = {0, 0, 0, h};          // heel
Point(2) = {base, 0, 0, h};       // toe
Point(3) = {crest, 0, height, h_top};
Point(4) = {0, 0, height, h_top};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
sides[] = Extrude {0, width, 0} { Surface{1}; Layers{1}; };

Physical Volume("concrete") = {sides[1]};
Physical Surface("base") = {sides[2]};
Physical Surface("downstream") = {sides[3]};
Physical Surface("crest") = {sides[4]};
Physical Surface("upstream") = {sides[5]};
Physical Surface("joints") = {1, sides[0]};

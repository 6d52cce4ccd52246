// A slice of nafems_cylinder.geo, 4 mm thick.

SetFactory("OpenCASCADE");  // it does not unite the two sides of contact

R = 50; flat = 9; side = 100; depth = 200; thickness = 4;  // mm

height = Sqrt(R*R - flat*flat);
Point(1) = {0, height, 0, 20};
Point(2) = {0, 0, 0, 1.5};
Point(3) = {flat, 0, 0, 2};
Point(4) = {R, height, 0, 20};
Line(1) = {2, 3};
Circle(2) = {3, 1, 4};
Line(3) = {4, 1};
Line(4) = {1, 2};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};

Point(5) = {0, -depth, 0, 50};
Point(6) = {side, -depth, 0, 50};
Point(7) = {side, 0, 0, 50};
Point(8) = {flat, 0, 0, 2};
Point(9) = {0, 0, 0, 1.5};
Line(5) = {5, 6};
Line(6) = {6, 7};
Line(7) = {7, 8};
Line(8) = {8, 9};
Line(9) = {9, 5};
Curve Loop(2) = {5, 6, 7, 8, 9};
Plane Surface(2) = {2};

upper[] = Extrude {0, 0, thickness} { Surface{1}; };
lower[] = Extrude {0, 0, thickness} { Surface{2}; };

Physical Volume("cylinder") = {upper[1]};
Physical Volume("block") = {lower[1]};
Physical Surface("cylinder.contact") = {upper[2]};
Physical Surface("block.contact") = {lower[5]};
Physical Surface("top") = {upper[4]};
Physical Surface("bottom") = {lower[2]};
Physical Surface("free") = {upper[3], lower[3], lower[4]};
Physical Surface("symmetry") = {upper[5], lower[6]};
Physical Surface("ends") = {1, 2, upper[0], lower[0]};

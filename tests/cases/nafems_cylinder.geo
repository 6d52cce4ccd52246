// NAFEMS, Advanced Finite Element Contact Benchmarks, 1: a cylinder of steel (R = 50 mm) on a block of aluminium (200 by 200 mm);
// the right half of it. The cylinder is cut straight where contact may be; the gap of the case is the distance of the circle.

R = 50; flat = 9; side = 100; depth = 200;  // mm

height = Sqrt(R*R - flat*flat);
Point(1) = {0, height, 0, 8};
Point(2) = {0, 0, 0, 1.5};
Point(3) = {flat, 0, 0, 1.5};
Point(4) = {R, height, 0, 8};
Line(1) = {2, 3};
Circle(2) = {3, 1, 4};
Line(3) = {4, 1};
Line(4) = {1, 2};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};

Point(5) = {0, -depth, 0, 25};
Point(6) = {side, -depth, 0, 25};
Point(7) = {side, 0, 0, 25};
Point(8) = {flat, 0, 0, 1.5};
Point(9) = {0, 0, 0, 1.5};
Line(5) = {5, 6};
Line(6) = {6, 7};
Line(7) = {7, 8};
Line(8) = {8, 9};
Line(9) = {9, 5};
Curve Loop(2) = {5, 6, 7, 8, 9};
Plane Surface(2) = {2};

Physical Surface("cylinder") = {1};
Physical Surface("block") = {2};
Physical Curve("cylinder.contact") = {1};
Physical Curve("block.contact") = {8};
Physical Curve("top") = {3};
Physical Curve("bottom") = {5};
Physical Curve("free") = {2, 6, 7};
Physical Curve("symmetry") = {4, 9};

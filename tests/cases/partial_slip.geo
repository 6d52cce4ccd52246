// A cylinder (R = 50 mm) on a block of the same material. Its lower half is cut straight where contact may be; the gap of the
// case is the distance of the circle.

R = 50; flat = 9; side = 150; depth = 200;  // mm

height = Sqrt(R*R - flat*flat);
Point(1) = {0, height, 0, 8};
Point(2) = {-flat, 0, 0, 1};
Point(3) = {flat, 0, 0, 1};
Point(4) = {R, height, 0, 8};
Point(5) = {-R, height, 0, 8};
Line(1) = {2, 3};
Circle(2) = {3, 1, 4};
Line(3) = {4, 5};
Circle(4) = {5, 1, 2};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};

Point(6) = {-flat, 0, 0, 1};
Point(7) = {flat, 0, 0, 1};
Point(8) = {side, 0, 0, 40};
Point(9) = {side, -depth, 0, 40};
Point(10) = {-side, -depth, 0, 40};
Point(11) = {-side, 0, 0, 40};
Line(6) = {6, 7};
Line(7) = {7, 8};
Line(8) = {8, 9};
Line(9) = {9, 10};
Line(10) = {10, 11};
Line(11) = {11, 6};
Curve Loop(2) = {6 ... 11};
Plane Surface(2) = {2};

Physical Surface("cylinder") = {1};
Physical Surface("block") = {2};
Physical Curve("cylinder.contact") = {1};
Physical Curve("block.contact") = {6};
Physical Curve("top") = {3};
Physical Curve("base") = {9};
Physical Curve("free") = {2, 4, 7, 8, 10, 11};

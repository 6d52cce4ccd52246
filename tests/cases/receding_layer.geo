// The right half of a layer of height 1 on a block that stands for a half-plane.

length = 15; side = 60;

Point(1) = {0, 0, 0, 0.2};
Point(2) = {3, 0, 0, 0.2};
Point(3) = {length, 0, 0, 0.8};
Point(4) = {length, 1, 0, 0.8};
Point(5) = {0.5, 1, 0, 0.1};
Point(6) = {0, 1, 0, 0.2};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 6};
Line(6) = {6, 1};
Curve Loop(1) = {1 ... 6};
Plane Surface(1) = {1};

Point(7) = {0, 0, 0, 0.2};
Point(8) = {3, 0, 0, 0.2};
Point(12) = {length, 0, 0, 0.8};
Point(9) = {side, 0, 0, 12};
Point(10) = {side, -side, 0, 12};
Point(11) = {0, -side, 0, 12};
Line(7) = {7, 8};
Line(8) = {8, 12};
Line(12) = {12, 9};
Line(9) = {9, 10};
Line(10) = {10, 11};
Line(11) = {11, 7};
Curve Loop(2) = {7, 8, 12, 9, 10, 11};
Plane Surface(2) = {2};

Physical Surface("layer") = {1};
Physical Surface("block") = {2};
Physical Curve("layer.contact") = {1, 2};
Physical Curve("block.contact") = {7, 8};
Physical Curve("loaded") = {5};
Physical Curve("free") = {3, 4, 9, 12};
Physical Curve("base") = {10};
Physical Curve("symmetry") = {6, 11};

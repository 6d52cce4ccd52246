// The right half of a block that stands for a half-plane; a rigid flat punch of half width 1 on its top.

side = 100;

Point(1) = {0, 0, 0, 0.2};
Point(2) = {1, 0, 0, 0.05};
Point(3) = {side, 0, 0, 20};
Point(4) = {side, -side, 0, 20};
Point(5) = {0, -side, 0, 20};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 1};
Curve Loop(1) = {1 ... 5};
Plane Surface(1) = {1};

Physical Surface("block") = {1};
Physical Curve("punch") = {1};
Physical Curve("free") = {2, 3};
Physical Curve("base") = {4};
Physical Curve("symmetry") = {5};

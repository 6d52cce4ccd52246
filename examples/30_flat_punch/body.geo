// The meridian of a cylinder of radius and height R, with a punch of radius a on the middle of its top.

a = 5;         // mm
R = 100;

Point(1) = {0, -R, 0, R/4};
Point(2) = {R, -R, 0, R/4};
Point(3) = {R, 0, 0, R/4};
Point(4) = {a, 0, 0, a/4};
Point(5) = {0, 0, 0, a/4};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 1};
Curve Loop(1) = {1, 2, 3, 4, 5};
Plane Surface(1) = {1};

Physical Surface("body") = {1};
Physical Curve("base") = {1};
Physical Curve("free") = {2, 3};
Physical Curve("punch") = {4};
Physical Curve("axis") = {5};

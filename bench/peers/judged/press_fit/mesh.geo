// A quarter of a ring, radii from 50 to 70 mm.
inner = 50; outer = 70;
n = 64;       // edges along the inside
Point(1) = {0, 0, 0};
Point(2) = {inner, 0, 0, inner*Pi/2/n};
Point(3) = {outer, 0, 0, 4};
Point(4) = {0, outer, 0, 4};
Point(5) = {0, inner, 0, inner*Pi/2/n};
Line(1) = {2, 3};
Circle(2) = {3, 1, 4};
Line(3) = {4, 5};
Circle(4) = {5, 1, 2};
Transfinite Curve {4} = n + 1;
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Physical Surface("ring") = {1};
Physical Curve("bottom") = {1};
Physical Curve("outside") = {2};
Physical Curve("left") = {3};
Physical Curve("contact") = {4};

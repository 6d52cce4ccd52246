// The lower right quarter of a disc that touches the plane y = 0 at the origin. Its surface is a polygon: where it may come
// into contact, neighbouring facets meet at an angle of 1.4 degrees.

R = 10;
cap = 0.3;     // angle of the part of the surface that may come into contact
h = 0.25;      // mesh size there
H = 1.5;

Point(1) = {0, R, 0, H};
Point(2) = {0, 0, 0, h};
Point(3) = {R*Sin(cap), R - R*Cos(cap), 0, h};
Point(4) = {R, R, 0, H};
Circle(1) = {2, 1, 3};
Circle(2) = {3, 1, 4};
Line(3) = {4, 1};
Line(4) = {1, 2};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};

Physical Surface("cylinder") = {1};
Physical Curve("contact") = {1};
Physical Curve("free") = {2};
Physical Curve("top") = {3};
Physical Curve("symmetry") = {4};

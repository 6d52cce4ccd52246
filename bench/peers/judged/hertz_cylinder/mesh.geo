// The lower right quarter of a disc of radius R that touches the plane y = 0 in the origin.
R = 10;        // mm
cap = 0.15;    // angle of the part of the surface that may come into contact
h = 0.1;       // mesh size at the contact, about an eighth of its half width
H = 1.5;       // and far from it

Point(1) = {0, R, 0, H};
Point(2) = {0, 0, 0, h};
Point(3) = {R*Sin(cap), R*(1 - Cos(cap)), 0, h};
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

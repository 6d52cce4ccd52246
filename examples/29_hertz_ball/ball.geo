// The meridian of the lower half of a ball of radius R around (0, R), its arc a polygon.

R = 10;        // mm
cap = 0.2;     // angle of the part of the surface that may come into contact
h = 0.4;       // mesh size at the contact: the run refines where it must
H = 2;         // and far from it

Point(1) = {0, R, 0, H};                              // centre
Point(2) = {0, 0, 0, h};                              // first point of contact
Point(3) = {R*Sin(cap), R*(1 - Cos(cap)), 0, h};
Point(4) = {R, R, 0, H};
Circle(1) = {2, 1, 3};
Circle(2) = {3, 1, 4};
Line(3) = {4, 1};
Line(4) = {1, 2};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};

Physical Surface("ball") = {1};
Physical Curve("contact") = {1};
Physical Curve("free") = {2};
Physical Curve("top") = {3};
Physical Curve("axis") = {4};

// A quarter of a disc of radius R that touches the plane y = 0 in the origin. Where it may come into contact it is cut straight:
// how far its surface is from the plane there is the gap of the case. Then the normal does not jump from facet to facet.

R = 10;        // mm
cap = 0.15;    // angle of the part of the surface that may come into contact
h = 0.15;      // mesh size at the contact; adaptation goes on from there
H = 2.0;       // and far from it

c = R*(1 - Cos(cap));
Point(1) = {0, R, 0, H};                // centre
Point(2) = {0, c, 0, h};                // first point of contact
Point(3) = {R*Sin(cap), c, 0, h};
Point(4) = {R, R, 0, H};
Line(1) = {2, 3};
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

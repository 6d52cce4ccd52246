// A quarter of the lower half of a ball of radius R that touches the plane y = 0 in the origin: x >= 0, z >= 0, y <= R. Where
// it may come into contact the ball is cut flat; how far its surface is from the plane there is the gap of the case file. In
// small displacements that is the same problem, and the normal does not jump from facet to facet.

R = 10;        // mm
cap = 0.25;    // angle of the part of the surface that may come into contact
h = 1;         // mesh size at the contact, about the radius of the contact: the run refines where it must
H = 2;         // and far from it
c = R*(1 - Cos(cap));
s = R*Sin(cap);

Point(1) = {0, R, 0, H};     // centre
Point(2) = {0, c, 0, h};     // first point of contact, and centre of the flat
Point(3) = {s, c, 0, h};
Point(4) = {0, c, s, h};
Point(6) = {R, R, 0, H};
Point(7) = {0, R, R, H};

Line(1) = {2, 3};
Circle(2) = {3, 2, 4};
Line(3) = {4, 2};
Circle(4) = {3, 1, 6};
Circle(5) = {6, 1, 7};
Circle(6) = {7, 1, 4};
Line(7) = {6, 1};
Line(8) = {1, 7};
Line(9) = {1, 2};

Curve Loop(1) = {1, 2, 3};
Plane Surface(1) = {1};                     // the flat
Curve Loop(2) = {4, 5, 6, -2};
Surface(2) = {2} In Sphere {1};             // the rest of the sphere
Curve Loop(3) = {-5, 7, 8};
Plane Surface(3) = {3};                     // y = R
Curve Loop(4) = {1, 4, 7, 9};
Plane Surface(4) = {4};                     // z = 0
Curve Loop(5) = {3, -9, 8, 6};
Plane Surface(5) = {5};                     // x = 0
Surface Loop(1) = {1, 2, 3, 4, 5};
Volume(1) = {1};

Physical Volume("ball") = {1};
Physical Surface("contact") = {1};
Physical Surface("free") = {2};
Physical Surface("top") = {3};
Physical Surface("symmetry_z") = {4};
Physical Surface("symmetry_x") = {5};

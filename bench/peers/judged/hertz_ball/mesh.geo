// A quarter of the lower half of a ball of radius R that touches the plane y = 0 in the origin.
R = 10;        // mm
cap = 0.2;     // angle of the part of the surface that may come into contact
h = 0.25;      // mesh size at the contact, about a quarter of its radius
H = 2.5;       // and far from it
c = R*(1 - Cos(cap));
s = R*Sin(cap);

Point(1) = {0, R, 0, H};     // centre
Point(2) = {0, 0, 0, h};     // first point of contact
Point(3) = {s, c, 0, h};
Point(4) = {0, c, s, h};
Point(5) = {0, c, 0, h};     // centre of the edge of the cap
Point(6) = {R, R, 0, H};
Point(7) = {0, R, R, H};

Circle(1) = {2, 1, 3};
Circle(2) = {3, 5, 4};
Circle(3) = {4, 1, 2};
Circle(4) = {3, 1, 6};
Circle(5) = {6, 1, 7};
Circle(6) = {7, 1, 4};
Line(7) = {6, 1};
Line(8) = {1, 7};
Line(9) = {1, 2};

Curve Loop(1) = {1, 2, 3};
Surface(1) = {1} In Sphere {1};             // the cap
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

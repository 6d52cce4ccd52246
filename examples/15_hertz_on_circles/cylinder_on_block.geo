// The lower right quarter of a disc of radius R around (0, R), its circumference a polygon, on a block: two bodies.

R = 10;        // mm
B = 20;        // width and height of the block
cap = 0.15;    // angle of the part of the surface that may come into contact
h = 0.4;       // mesh size at the contact
H = 2.5;       // and far from it

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

Point(11) = {0, 0, 0, 0.7*h};
Point(12) = {1.8, 0, 0, 0.7*h};
Point(13) = {B, 0, 0, H};
Point(14) = {B, -B, 0, H};
Point(15) = {0, -B, 0, H};
Line(11) = {11, 12};
Line(12) = {12, 13};
Line(13) = {13, 14};
Line(14) = {14, 15};
Line(15) = {15, 11};
Curve Loop(2) = {11, 12, 13, 14, 15};
Plane Surface(2) = {2};

Physical Surface("cylinder") = {1};
Physical Surface("block") = {2};
Physical Curve("cylinder.contact") = {1};
Physical Curve("block.top") = {11};
Physical Curve("free") = {2, 12, 13};
Physical Curve("top") = {3};
Physical Curve("symmetry") = {4, 15};
Physical Curve("base") = {14};

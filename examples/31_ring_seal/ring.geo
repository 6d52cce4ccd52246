// The upper half of the section of a ring: a disc of radius a around (R, 0).

R = 20;        // mm
a = 2;
h = 0.25;
top = Pi/3;    // from the direction of r: beyond this angle the ring may touch the lid, before it the wall
side = 2*Pi/3; // beyond this one it is under the pressure of the fluid

Point(1) = {R, 0, 0, 2*h};
Point(2) = {R + a, 0, 0, h};
Point(3) = {R + a*Cos(top), a*Sin(top), 0, h};
Point(4) = {R + a*Cos(side), a*Sin(side), 0, h};
Point(5) = {R - a, 0, 0, h};
Circle(1) = {2, 1, 3};
Circle(2) = {3, 1, 4};
Circle(3) = {4, 1, 5};
Line(4) = {5, 1};
Line(5) = {1, 2};
Curve Loop(1) = {1, 2, 3, 4, 5};
Plane Surface(1) = {1};

Physical Surface("ring") = {1};
Physical Curve("wall") = {1};
Physical Curve("lid") = {2};
Physical Curve("fluid") = {3};
Physical Curve("middle") = {4, 5};

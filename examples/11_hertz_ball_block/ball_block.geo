// A quarter of the lower half of a ball of radius R that touches, in the origin, a block below y = 0: x >= 0, z >= 0. Where
// it may come into contact the ball is cut flat, along y = 0; how far its surface is from the block there is the gap of the
// case file. In small displacements that is the same problem, and the normal does not jump from facet to facet.

R = 10;        // mm
flat = 2.5;    // radius of the part of the surface that may come into contact
L = 12;        // edges of the quarter of the block
h = 1;         // mesh size at the contact, about the radius of the contact: the run refines where it must
H = 3;         // and far from it

// The block first: Extrude makes one point of those in one place, and the bodies share none.
Point(1) = {0, 0, 0, 0.8*h};
Point(2) = {L, 0, 0, H};
Point(3) = {L, 0, L, H};
Point(4) = {0, 0, L, H};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
block[] = Extrude {0, -L, 0} { Surface{1}; };
MeshSize { PointsOf { Surface{block[0]}; } } = H;

c = Sqrt(R*R - flat*flat);
Point(101) = {0, c, 0, H};                  // centre of the ball
Point(102) = {0, 0, 0, h};                  // first point of contact, and centre of the flat
Point(103) = {flat, 0, 0, h};
Point(104) = {0, 0, flat, h};
Point(105) = {R, c, 0, H};
Point(106) = {0, c, R, H};
Line(101) = {102, 103};
Circle(102) = {103, 102, 104};
Line(103) = {104, 102};
Circle(104) = {103, 101, 105};
Circle(105) = {105, 101, 106};
Circle(106) = {106, 101, 104};
Line(107) = {105, 101};
Line(108) = {101, 106};
Line(109) = {101, 102};
Curve Loop(101) = {101, 102, 103};
Plane Surface(101) = {101};                 // the flat
Curve Loop(102) = {104, 105, 106, -102};
Surface(102) = {102} In Sphere {101};       // the rest of the sphere
Curve Loop(103) = {-105, 107, 108};
Plane Surface(103) = {103};                 // the plane through the centre
Curve Loop(104) = {101, 104, 107, 109};
Plane Surface(104) = {104};                 // z = 0
Curve Loop(105) = {103, -109, 108, 106};
Plane Surface(105) = {105};                 // x = 0
Surface Loop(101) = {101, 102, 103, 104, 105};
Volume(101) = {101};

Physical Volume("ball") = {101};
Physical Volume("block") = {block[1]};
Physical Surface("ball.contact") = {101};
Physical Surface("block.top") = {1};
Physical Surface("load") = {103};
Physical Surface("bottom") = {block[0]};
Physical Surface("symmetry_z") = {104, block[2]};
Physical Surface("symmetry_x") = {105, block[5]};
Physical Surface("free") = {102, block[3], block[4]};

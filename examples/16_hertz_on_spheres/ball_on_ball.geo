// Quarters of two half balls that touch in the origin: the lower half of one of radius R around (0, R, 0) on the upper half of one
// of radius S around (0, -S, 0), x >= 0 and z >= 0. Their surfaces are facets; the cap of each where they may touch is a group.
SetFactory("Built-in");

R = 10;        // mm
S = 15;
reach = 2.2;   // radius of the caps
h = 1;         // mesh size at the contact, about the radius of the contact: the run refines where it must

// Points, curves and surfaces from 100 k on: `up` is 1 above y = 0, -1 below.
Macro Quarter
  s = reach;
  c = up*(r - Sqrt(r*r - s*s));
  Point(k + 1) = {0, up*r, 0, H};      // centre
  Point(k + 2) = {0, 0, 0, size};      // first point of contact
  Point(k + 3) = {s, c, 0, size};
  Point(k + 4) = {0, c, s, size};
  Point(k + 5) = {0, c, 0, size};      // centre of the rim of the cap
  Point(k + 6) = {r, up*r, 0, H};
  Point(k + 7) = {0, up*r, r, H};
  Circle(k + 1) = {k + 2, k + 1, k + 3};
  Circle(k + 2) = {k + 3, k + 5, k + 4};
  Circle(k + 3) = {k + 4, k + 1, k + 2};
  Circle(k + 4) = {k + 3, k + 1, k + 6};
  Circle(k + 5) = {k + 6, k + 1, k + 7};
  Circle(k + 6) = {k + 7, k + 1, k + 4};
  Line(k + 7) = {k + 6, k + 1};
  Line(k + 8) = {k + 1, k + 7};
  Line(k + 9) = {k + 1, k + 2};
  Curve Loop(k + 1) = {k + 1, k + 2, k + 3};
  Surface(k + 1) = {k + 1} In Sphere {k + 1};           // the cap
  Curve Loop(k + 2) = {k + 4, k + 5, k + 6, -(k + 2)};
  Surface(k + 2) = {k + 2} In Sphere {k + 1};           // the rest of the sphere
  Curve Loop(k + 3) = {-(k + 5), k + 7, k + 8};
  Plane Surface(k + 3) = {k + 3};                       // the plane through the centre
  Curve Loop(k + 4) = {k + 1, k + 4, k + 7, k + 9};
  Plane Surface(k + 4) = {k + 4};                       // z = 0
  Curve Loop(k + 5) = {k + 3, -(k + 9), k + 8, k + 6};
  Plane Surface(k + 5) = {k + 5};                       // x = 0
  Surface Loop(k + 1) = {k + 1, k + 2, k + 3, k + 4, k + 5};
  Volume(k + 1) = {k + 1};
Return

k = 100; up = 1; r = R; size = h; H = 3;
Call Quarter;
k = 200; up = -1; r = S; size = 0.8*h; H = 4;
Call Quarter;

Physical Volume("upper") = {101};
Physical Volume("lower") = {201};
Physical Surface("upper.contact") = {101};
Physical Surface("lower.contact") = {201};
Physical Surface("load") = {103};
Physical Surface("bottom") = {203};
Physical Surface("symmetry_z") = {104, 204};
Physical Surface("symmetry_x") = {105, 205};
Physical Surface("free") = {102, 202};

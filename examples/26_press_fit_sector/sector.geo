// 30 degrees of a hub on a hollow shaft, lengths in mm: radii 40, 50, 70, half of their length of 20. One mesh: the run cuts it
// open along "fit".
n = 8;               // facets along the arcs
half = Pi / 12;      // the planes of symmetry are at -half and half from the x axis

radii[] = {40, 50, 70};
For i In {0 : 2}
  Point(2 * i + 1) = {radii[i] * Cos(half), -radii[i] * Sin(half), 0};
  Point(2 * i + 2) = {radii[i] * Cos(half), -radii[i] * Sin(half), 10};
  Line(i + 1) = {2 * i + 1, 2 * i + 2};
EndFor
For i In {0 : 1}
  Line(10 + i) = {2 * i + 1, 2 * i + 3};
  Line(20 + i) = {2 * i + 2, 2 * i + 4};
  Curve Loop(i + 1) = {10 + i, i + 2, -(20 + i), -(i + 1)};
  Plane Surface(i + 1) = {i + 1};
EndFor
Transfinite Curve {1, 2, 3, 10, 20} = n / 2 + 1;
Transfinite Curve {11, 21} = n + 1;
Transfinite Surface {1, 2};
shaft[] = Extrude { {0, 0, 1}, {0, 0, 0}, 2 * half } { Surface{1}; Layers{n}; };   // upper plane, volume; back, outside, front, inside
hub[] = Extrude { {0, 0, 1}, {0, 0, 0}, 2 * half } { Surface{2}; Layers{n}; };

Physical Volume("shaft") = {shaft[1]};
Physical Volume("hub") = {hub[1]};
Physical Surface("fit") = {shaft[3]};
Physical Surface("lower") = {1, 2};
Physical Surface("upper") = {shaft[0], hub[0]};
Physical Surface("back") = {shaft[2], hub[2]};
Physical Surface("free") = {shaft[4], shaft[5], hub[3], hub[4]};

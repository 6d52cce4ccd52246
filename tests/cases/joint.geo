// A wall with a crack from the left that ends inside, and a joint all the way through, which does not cross the crack.
SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 2, 1};
Point(11) = {0, 0.3, 0};
Point(12) = {0.9, 0.45, 0};
Point(13) = {1.4, 0, 0};
Point(14) = {1.5, 1, 0};
Line(11) = {11, 12};
Line(12) = {13, 14};
BooleanFragments{ Surface{1}; Delete; }{ Curve{11, 12}; Delete; }
Mesh.MeshSizeMax = 0.25;
eps = 1e-6;
Physical Surface("wall") = Surface{:};
Physical Curve("crack") = Curve In BoundingBox{-eps, 0.3 - eps, -1, 0.9 + eps, 0.45 + eps, 1};
Physical Curve("joint") = Curve In BoundingBox{1.4 - eps, -eps, -1, 1.5 + eps, 1 + eps, 1};
Physical Curve("left") = Curve In BoundingBox{-eps, -eps, -1, eps, 1 + eps, 1};
Physical Curve("right") = Curve In BoundingBox{2 - eps, -eps, -1, 2 + eps, 1 + eps, 1};
Physical Curve("bottom") = Curve In BoundingBox{-eps, -eps, -1, 2 + eps, eps, 1};
Physical Curve("top") = Curve In BoundingBox{-eps, 1 - eps, -1, 2 + eps, 1 + eps, 1};

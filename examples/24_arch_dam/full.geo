// The dam on a finer mesh.
h = 9;
Include "dam.geo";

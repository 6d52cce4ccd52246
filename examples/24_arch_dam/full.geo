// The dam on a finer mesh.
h = 8;
Include "dam.geo";

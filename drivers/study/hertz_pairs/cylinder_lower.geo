// See cylinder.geo.
R = 40; side = -1; h = 0.01;
Include "cylinder.geo";

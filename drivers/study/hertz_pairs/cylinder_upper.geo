// See cylinder.geo.
R = 60; side = 1; h = 0.013;
Include "cylinder.geo";

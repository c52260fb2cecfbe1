// See cup.geo.
R = -20.05; size = 50; a = 12.5; h = 0.9; slope = 0.06;
Include "cup.geo";

// See cup.geo.
R = -22; size = 50; a = 0.5; h = 0.06; slope = 0.25;
Include "cup.geo";

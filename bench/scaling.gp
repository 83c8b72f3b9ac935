# How step, kernel and fit grow, as scripts/bench draws it: gnuplot -e "data='...'; svg='...'" bench/scaling.gp
set terminal svg size 900,380 font "sans-serif,12" background "white"
set output svg
set logscale xy
set grid
set key left top
lines(pattern) = sprintf("< grep '^%s ' '%s'", pattern, data)
set multiplot layout 1,2
set title "one sample"
set xlabel "sensors n"
set ylabel "ns (processor time)"
set xrange [3.5:18]
set xtics (4, 6, 8, 16)
plot lines("BM_MonitorStep") using 2:3 with linespoints pt 7 title "whole step, nominal", \
     lines("BM_Kernel") using 2:3 with linespoints pt 5 title "all triples and window"
set key right bottom
set title "one fit"
set xlabel "attitudes N"
set ylabel "us (processor time)"
set xrange [10:1200]
set xtics (12, 24, 48, 100, 250, 500, 1000)
plot for [n in "4 6 8 12 16"] lines("BM_Fit ".n) using 3:4 with linespoints pt 7 title "n = ".n
unset multiplot

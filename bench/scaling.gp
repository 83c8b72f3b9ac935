# How step, kernel and fit grow, from the CSV of plumb_bench: gnuplot -e "csv='...'; svg='...'" bench/scaling.gp
set terminal svg size 900,380 font "sans-serif,12" background "white"
set output svg
set datafile separator ","
set logscale xy
set grid
set key left top
# "BM_Kernel/8",iterations,real,cpu,unit,... : pairs of n (or N) and time.
of(name) = sprintf("grep '^\"%s' '%s' | sed -E 's@^\"[^\"]*[/:]([0-9]+)\",@\\1,@'", name, csv)
set multiplot layout 1,2
set title "one sample"
set xlabel "sensors n"
set ylabel "ns (processor time)"
set xrange [3.5:18]
set xtics (4, 6, 8, 16)
plot "< ".of("BM_MonitorStep/") using 1:4 with linespoints pt 7 title "whole step, nominal", \
     "< ".of("BM_Kernel/") using 1:4 with linespoints pt 5 title "all triples and window"
set title "one fit"
set xlabel "attitudes N"
set ylabel "us (processor time)"
set xrange [10:1200]
set xtics (12, 24, 48, 100, 250, 500, 1000)
plot for [n in "4 6 8 12 16"] "< ".of("BM_Fit/n:".n."/") using 1:4 with linespoints pt 7 title "n = ".n
unset multiplot

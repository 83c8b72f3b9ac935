# The figure docs/attitude-filter.svg:
#   build/release/examples/navigation/plumb_attitude_filter > attitude_filter.txt
#   gnuplot examples/navigation/attitude_filter.gp > docs/attitude-filter.svg
set terminal svg size 900,420 font "sans-serif,13" noenhanced background "#ffffff"
set encoding utf8
set datafile separator whitespace
set xlabel "time [s]"
set ylabel "error of the attitude [deg]"
set logscale y
set yrange [0.001:20]
set xrange [6:72]
set format y "%g"
set ytics add ("0.001" 0.001, "0.01" 0.01, "0.1" 0.1, "1" 1, "10" 10)
set key outside top center horizontal Left reverse samplen 2
set object 1 rectangle from 30.0,0.001 to 41.59,20 behind fillcolor rgb "#fbf1dc" fillstyle solid noborder
set label 1 "a2 dies: plumb\ndoubts, the gyro\ncarries on" at 30.4,0.9
set label 2 "a2 is out;\nthree sensors go on" at 42.2,0.6
plot "attitude_filter.txt" using 1:4 with lines linewidth 1.6 linecolor rgb "#c53a3a" title "least squares of all four, length within 5 %", \
     "attitude_filter.txt" using 1:2 with lines linewidth 1.6 linecolor rgb "#2c8f57" title "plumb's vector, covariance and validity", \
     "attitude_filter.txt" using 1:3 with lines linewidth 1.0 dashtype 2 linecolor rgb "#555555" title "1 sigma that the filter states"

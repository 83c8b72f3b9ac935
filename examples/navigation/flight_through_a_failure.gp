# The figure docs/flight-through-a-failure.svg:
#   build/release/examples/navigation/plumb_flight_through_a_failure 1 flight_through_a_failure.csv
#   gnuplot examples/navigation/flight_through_a_failure.gp > docs/flight-through-a-failure.svg
set terminal svg size 900,420 font "sans-serif,13" noenhanced background "#ffffff"
set encoding utf8
set datafile separator ","
set xlabel "time [s]"
set ylabel "error of the velocity [m/s]"
set logscale y
set yrange [0.003:20]
set xrange [0:20]
set format y "%g"
set ytics ("0.003" 0.003, "0.01" 0.01, "0.03" 0.03, "0.1" 0.1, "0.3" 0.3, "1" 1, "3" 3, "10" 10)
set key outside top center horizontal Left reverse samplen 2
set arrow 1 from 8,0.003 to 8,20 nohead dashtype 3 linecolor rgb "#555555"
set label 1 "chip 2 fails, and is\nout after 0.07 s" at 8.15,0.007
of(name, column) = (strcol(1) eq name ? column : NaN)
data = "flight_through_a_failure.csv"
plot data using 2:(of("biased", $5)) with lines linewidth 1.6 linecolor rgb "#e39a9a" title "average, biased by 0.1 g", \
     data using 2:(of("dead", $5)) with lines linewidth 1.6 linecolor rgb "#c53a3a" title "average, dead", \
     data using 2:(of("biased", $3)) with lines linewidth 1.6 linecolor rgb "#8cc9a4" title "plumb, biased by 0.1 g", \
     data using 2:(of("dead", $3)) with lines linewidth 1.6 linecolor rgb "#2c8f57" title "plumb, dead", \
     data using 2:(of("dead", $4)) with lines linewidth 1.0 dashtype 2 linecolor rgb "#555555" title "what plumb's bound allows"

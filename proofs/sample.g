# From the six-term form to the integer that enters the window (src/detection/combination_mae.cpp): square root, minus
# gravity, times the units to the m/s^2, rounded. "Square" is exact, "square" computed, as far apart as form.g allows.
# Range: lengths from 4 to 300 m/s^2. The code takes the absolute value before the product; product and rounding are odd
# functions, so it stores |stored|, and ||stored| - |Error| * per| is no larger than the difference bounded here.
# constant kSampleError_units 0x1.0ap-1
@double = float<ieee_64, ne>;
square = double(square_); G = double(G_);
per = 0x1p22;
length double= sqrt(square);
Length = sqrt(Square);
error double= length - G;
Error = Length - G;
units double= error * per;
stored = int<ne>(units);             # halves to even

{ |square - Square| <= 0x1.35p-25 /\ Square in [16, 90000] /\ G in [9, 10]
  -> |stored - Error * per| <= 0x1.0ap-1 /\ stored in [-2140000000, 2140000000] }

stored - Error * per -> (stored - units) + (units - error * per) + (error - Error) * per;

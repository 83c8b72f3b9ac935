# From the six-term form to the integer that enters the window (src/detection/combination_mae.cpp): square root, minus
# gravity, divided by the unit, rounded. "Square" is exact, "square" computed, as far apart as form.g allows.
# Range: lengths from 4 to 300 m/s^2. The code takes the absolute value before the division; division and rounding are odd
# functions, so it stores |stored|, and ||stored| - |Error|/unit| is no larger than the difference bounded here.
# constant kSampleError_units 0x1.1p-1
@double = float<ieee_64, ne>;
square = double(square_); G = double(G_);
unit = 0x1.39d013a92a305p-23;        # 9.80665 / 2^26 as the compiler reads it
length double= sqrt(square);
Length = sqrt(Square);
error double= length - G;
Error = Length - G;
units double= error / unit;
stored = int<ne>(units);             # halves to even

{ |square - Square| <= 0x1.35p-25 /\ Square in [16, 90000] /\ G in [9, 10]
  -> |stored - Error / unit| <= 0x1.1p-1 /\ stored in [-2140000000, 2140000000] }

stored - Error / unit -> (stored - units) + (units - error / unit) + (error - Error) / unit;

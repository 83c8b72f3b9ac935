# From the change of a squared length to the integer that enters the window (src/detection/near_lengths.cpp), in binary32: root,
# quotient, product, rounding. What is known at the first readings of the block is rounded to binary32 once; the error there is a
# whole number of units, which is exact, and a fraction. "Change" is exact, "change" computed, as far apart as near_form.g allows.
# Range: lengths of 8 to 12 m/s^2 at the first readings, squares that change by up to 8 (m/s^2)^2. The code adds "moved" to that
# whole number and takes the absolute value, neither of which adds to the difference bounded here.
# constant kNearSampleError_units 0x1.46p4
@single = float<ieee_32, ne>;
per = 0x1p22;
square = single(Square);
length = single(sqrt(Square));
fraction = single(Fraction);
change = single(change_);
sum single= length + sqrt(single(square + change));
Sum = sqrt(Square) + sqrt(Square + Change);
ratio single= change / sum;
Ratio = Change / Sum;                # the change of the length
units single= ratio * per + fraction;
moved = int<ne>(units);              # halves to even
Units = Ratio * per + Fraction;

{ Square in [64, 144] /\ Change in [-8, 8] /\ |change - Change| <= 0x1.1fp-14 /\ Fraction in [-0.5, 0.5]
  -> |moved - Units| <= 0x1.46p4 }

ratio - Ratio -> (ratio - change / sum) + (change - Change) / sum + Change * ((Sum - sum) / (sum * Sum)) { sum <> 0, Sum <> 0 };
moved - Units -> (moved - units) + (units - (single(ratio * per) + fraction)) + (single(ratio * per) - ratio * per)
  + (ratio - Ratio) * per + (fraction - Fraction);

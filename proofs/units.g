# The conversion to fixed point alone, to_mae_units of src/detection/combination_mae.cpp: below the clamp the integer is within
# half a unit of the error that it stands for and fits 32 bits. (The product is exact, as its factor is a power of two; gappa
# does not see that, and 2^-23 of a unit stands for its rounding.)
# constant kUnitsError_units 0x1.000004p-1
@double = float<ieee_64, ne>;
error = double(error_);
per = 0x1p22;
units double= error * per;
stored = int<ne>(units);

{ units in [0, 2140000000] -> |stored - error * per| <= 0x1.000004p-1 /\ stored in [0, 2140000000] }


# The conversion to fixed point alone, to_mae_units of src/detection/combination_mae.cpp: below the clamp the integer is within
# half a unit (and the rounding of one division) of the error that it stands for, and fits 32 bits.
# constant kUnitsError_units 0x1.000004p-1
@double = float<ieee_64, ne>;
error = double(error_);
unit = 0x1.39d013a92a305p-23;
units double= error / unit;
stored = int<ne>(units);

{ units in [0, 2140000000] -> |stored - error / unit| <= 0x1.000004p-1 /\ stored in [0, 2140000000] }


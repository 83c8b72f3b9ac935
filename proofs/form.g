# The six-term form, squared_length of include/plumb/detection/combination_mae.hpp, in binary64, left to right, as every lane
# of the code computes it: how far from the exact value? Range: readings up to 160 m/s^2 (16 g0) and the coefficients of a
# triple that votes (|det| >= 0.05: |w|^2 <= 400 for unit axes; 401 leaves room for the tolerance of their length).
# (For all ranges, relative to the size of the terms: proofs/rounding/Rounding.v.)
# constant kFormErrorInRange_m2ps4 0x1.35p-25
@double = float<ieee_64, ne>;
a = double(a_); b = double(b_); c = double(c_);
q0 = double(q0_); q1 = double(q1_); q2 = double(q2_); q3 = double(q3_); q4 = double(q4_); q5 = double(q5_);
square double= q0*a*a + q1*b*b + q2*c*c + q3*a*b + q4*a*c + q5*b*c;
Square = q0*a*a + q1*b*b + q2*c*c + q3*a*b + q4*a*c + q5*b*c;

{ a in [-160, 160] /\ b in [-160, 160] /\ c in [-160, 160] /\
  q0 in [0, 401] /\ q1 in [0, 401] /\ q2 in [0, 401] /\ q3 in [-802, 802] /\ q4 in [-802, 802] /\ q5 in [-802, 802]
  -> |square - Square| <= 0x1.35p-25 }

# What the squared length of a triple changes by, near_change of include/plumb/detection/detail/near_lengths.hpp, in binary32, left to
# right, from coefficients, slopes and differences that are known exactly and rounded to binary32 first: how far from the exact
# value? Range: readings that differ from the first of their block by up to 1/8 m/s^2, the coefficients of a triple that votes
# (as in form.g), and its slopes where the first readings make a length up to 12 m/s^2 (twice 20.03 times 12).
# constant kNearFormError_m2ps4 0x1.1fp-14
@single = float<ieee_32, ne>;
a = single(A); b = single(B); c = single(C);
s0 = single(S0); s1 = single(S1); s2 = single(S2);
q0 = single(Q0); q1 = single(Q1); q2 = single(Q2); q3 = single(Q3); q4 = single(Q4); q5 = single(Q5);
change single= a*(s0 + q0*a + q3*b + q4*c) + b*(s1 + q1*b + q5*c) + c*(s2 + q2*c);
Change = A*(S0 + Q0*A + Q3*B + Q4*C) + B*(S1 + Q1*B + Q5*C) + C*(S2 + Q2*C);

{ A in [-0.125, 0.125] /\ B in [-0.125, 0.125] /\ C in [-0.125, 0.125] /\
  S0 in [-481, 481] /\ S1 in [-481, 481] /\ S2 in [-481, 481] /\
  Q0 in [0, 401] /\ Q1 in [0, 401] /\ Q2 in [0, 401] /\ Q3 in [-802, 802] /\ Q4 in [-802, 802] /\ Q5 in [-802, 802]
  -> |change - Change| <= 0x1.1fp-14 }

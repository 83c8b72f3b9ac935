// A library that scripts/check_symbols has to refuse.
int* decoy();
int* decoy() { return new int[64]; }

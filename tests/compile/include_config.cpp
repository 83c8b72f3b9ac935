// Compiles as it is; must not with -ffast-math or with a capacity that does not exist.
#include "plumb/core/config.hpp"

int main() { return plumb::kCapacity > 0 ? 0 : 1; }

// Links against the library of its own capacity, and against no other.
#include "plumb/array/sensor_array.hpp"

int main() { return plumb::make_id("a")[0] == 'a' ? 0 : 1; }

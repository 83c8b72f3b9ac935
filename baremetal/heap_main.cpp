// Must not link on the target: newlib's operator new asks for `_sbrk`, which nobody offers.
#include <vector>

extern "C" int application();
int application() {
  volatile unsigned size = 8;
  const std::vector<int> numbers(size, 1);
  return numbers[size - 1];
}

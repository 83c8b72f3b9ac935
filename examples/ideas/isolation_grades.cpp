// How many faulty sensors a geometry can isolate: with confirmation (confirmed grade), provisionally by parity alone
// (provisional grade).
#include <cstdio>

#include "plumb/array/geometry.hpp"
#include "plumb/array/named.hpp"
#include "plumb/array/sensor_array.hpp"

int main() {
  for (const bool with_axis : {false, true}) {
    for (int n = 4; n <= 8; ++n) {
      plumb::AxisList axes{};
      plumb::SensorRow rows[8];
      with_axis ? plumb::cone_with_axis(axes, n) : plumb::cone(axes, n);
      for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) {
        const char id[] = {'a', static_cast<char>('1' + i), '\0'};
        rows[i] = {plumb::make_id(id), axes[i], 0.002};
      }
      const plumb::FiguresOfMerit f = plumb::figures_of_merit(*plumb::SensorArray::make(rows, n));
      std::printf("%s:%d  confirmed %d, provisional %d, %d axes in one plane, noise gain %.2f\n",
                  with_axis ? "cone-axis" : "cone", n, f.confirmed_grade, f.provisional_grade, f.coplanarity, f.gdop);
    }
  }
}

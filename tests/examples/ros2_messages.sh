#!/usr/bin/env bash
# ros2_messages.sh REPOSITORY WORK LIBRARY COMPILER FLAGS...: generates sensor_msgs/Imu and diagnostic_msgs/DiagnosticStatus with
# Debian's rosidl and runs the tests of the ROS 2 adapter against them. 77 = skipped. Debian 12 has the generators of
# ROS 2 but the message files of ROS 1 only: these differ in the header (a sequence number, the name of time), which is
# put right here.
set -euo pipefail
repository="$1" work="$2" library="$3" compiler="$4"
shift 4
share="${PLUMB_MESSAGES_DIR:-/usr/share}"
skip() { echo "skipped: $1 (Debian: apt-get install $2)"; exit 77; }
command -v rosidl >/dev/null || skip "no rosidl" rosidl-tools
[[ -f /usr/share/rosidl_generator_cpp/package.xml ]] || skip "no C++ generator of rosidl" rosidl-generator-c-cpp
[[ -d /usr/include/rosidl_runtime_cpp ]] || skip "no runtime headers of rosidl" librosidl-runtime-c-cpp-dev
/usr/bin/python3 -c "import ament_index_python" 2>/dev/null || skip "no ament index" python3-ament-index
/usr/bin/python3 -c "import yaml" 2>/dev/null || skip "no yaml, which rosidl needs" python3-yaml
[[ -f "$share/sensor_msgs/msg/Imu.msg" ]] || skip "no sensor_msgs" ros-sensor-msgs
[[ -f "$share/diagnostic_msgs/msg/DiagnosticStatus.msg" ]] || skip "no diagnostic_msgs" ros-diagnostic-msgs

rm -rf "$work"
mkdir -p "$work"/msg/{builtin_interfaces,std_msgs,geometry_msgs,sensor_msgs,diagnostic_msgs}/msg
cd "$work"
printf 'int32 sec\nuint32 nanosec\n' >msg/builtin_interfaces/msg/Time.msg
sed -e '/^uint32 seq/d' -e 's|^time |builtin_interfaces/Time |' "$share/std_msgs/msg/Header.msg" >msg/std_msgs/msg/Header.msg
cp "$share"/geometry_msgs/msg/{Vector3,Quaternion}.msg msg/geometry_msgs/msg/
sed 's|^Header |std_msgs/Header |' "$share/sensor_msgs/msg/Imu.msg" >msg/sensor_msgs/msg/Imu.msg
cp "$share"/diagnostic_msgs/msg/{KeyValue,DiagnosticStatus}.msg msg/diagnostic_msgs/msg/
for package in builtin_interfaces std_msgs geometry_msgs sensor_msgs diagnostic_msgs; do
  files=()
  for file in "msg/$package"/msg/*.msg; do files+=("msg/$package:msg/$(basename "$file")"); done
  AMENT_PREFIX_PATH=/usr rosidl generate -o "out/$package" -t cpp -I msg "$package" "${files[@]}" >"$package.log" 2>&1 \
    || { cat "$package.log"; exit 1; }
done
runtime=()
for folder in /usr/include/rosidl_*; do runtime+=(-isystem "$folder"); done
"$compiler" -std=c++17 "$@" -Wall -Wextra -Wconversion -Werror -DPLUMB_CAPACITY=8 -DPLUMB_ROS2_GENERATED \
  -isystem out "${runtime[@]}" -isystem /usr/include/eigen3 -I "$repository/include" -I "$repository/examples" \
  -I "$repository/tests/examples" "$repository/tests/examples/ros2_test.cpp" "$library" -lgtest -lgtest_main -pthread -o ros2_test
./ros2_test --gtest_brief=1

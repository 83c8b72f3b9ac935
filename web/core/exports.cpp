// What the page calls. Text goes in through `plumb_text` and comes out at `plumb_answer`.
#include <cstddef>
#include <string>

#include "explorer.hpp"

namespace {

std::string text, answer;
plumb_web::Play play;
double digest_halves[4];

int answered(std::string with) {
  answer = std::move(with);
  return static_cast<int>(answer.size());
}

}  // namespace

/// Room for the next question, UTF-8.
extern "C" __attribute__((export_name("plumb_text"))) char* plumb_text(std::size_t bytes) {
  text.assign(bytes, '\0');
  return text.data();
}
extern "C" __attribute__((export_name("plumb_answer"))) const char* plumb_answer() { return answer.data(); }

// Each answers with the bytes of its text.
extern "C" __attribute__((export_name("plumb_vocabulary"))) int plumb_vocabulary() {
  return answered(plumb_web::vocabulary());
}
extern "C" __attribute__((export_name("plumb_builtin"))) int plumb_builtin() {
  return answered(plumb_web::builtin_axes(text));
}
extern "C" __attribute__((export_name("plumb_study"))) int plumb_study() { return answered(plumb_web::study(text)); }
extern "C" __attribute__((export_name("plumb_begin"))) int plumb_begin() { return answered(play.begin(text)); }
extern "C" __attribute__((export_name("plumb_files"))) int plumb_files() { return answered(play.files()); }

extern "C" __attribute__((export_name("plumb_run"))) int plumb_run(int samples) { return play.run(samples); }
extern "C" __attribute__((export_name("plumb_records"))) const double* plumb_records() { return play.records().data(); }
extern "C" __attribute__((export_name("plumb_record_count"))) std::size_t plumb_record_count() {
  return play.records().size() / plumb_web::record_names().size();
}
/// Of the digest and of that of the decisions two halves of 32 bits: JavaScript's numbers hold them exactly.
extern "C" __attribute__((export_name("plumb_digest"))) const double* plumb_digest() {
  digest_halves[0] = static_cast<double>(play.digest() >> 32U);
  digest_halves[1] = static_cast<double>(play.digest() & 0xffffffffU);
  digest_halves[2] = static_cast<double>(play.decisions() >> 32U);
  digest_halves[3] = static_cast<double>(play.decisions() & 0xffffffffU);
  return digest_halves;
}

// The stack of errors, one for the process: hdGetError takes the youngest.
#include "fakehd_state.hpp"

namespace fakehd {
namespace {

constexpr std::size_t kMostErrors = 4096;  // against a caller that never takes them

struct Text {
  unsigned code;
  const char* words;
};

constexpr Text kTexts[] = {{hd::kSuccess, "fake: no error"},
                           {hd::kInvalidEnum, "fake: no such name"},
                           {hd::kInvalidValue, "fake: value not allowed"},
                           {hd::kInvalidOperation, "fake: not possible now"},
                           {hd::kInvalidInputType, "fake: not of this type"},
                           {hd::kBadHandle, "fake: no such device is open"},
                           {hd::kWarmMotors, "fake: motors are warm"},
                           {hd::kExceededMaxForce, "fake: force above the limit"},
                           {hd::kExceededMaxForceImpulse, "fake: force changed too fast"},
                           {hd::kExceededMaxVelocity, "fake: moved too fast"},
                           {hd::kForceError, "fake: force cannot be sent"},
                           {hd::kDeviceFault, "fake: device at fault"},
                           {hd::kDeviceAlreadyInitiated, "fake: device is open already"},
                           {hd::kCommError, "fake: device does not answer"},
                           {hd::kCommConfigError, "fake: no device of this name"},
                           {hd::kTimerError, "fake: timer failed"},
                           {hd::kIllegalBegin, "fake: frame begun twice"},
                           {hd::kIllegalEnd, "fake: frame ended but not begun"},
                           {hd::kFrameError, "fake: outside of a frame"},
                           {hd::kInvalidPriority, "fake: priority not allowed"},
                           {hd::kSchedulerFull, "fake: too many callbacks"},
                           {hd::kInvalidLicense, "fake: license refused"}};

}  // namespace

void push_error(State& s, unsigned code, unsigned handle, int internal) {
  ++s.errors_pushed;
  if (s.errors.size() == kMostErrors) s.errors.pop_front();
  s.errors.push_back({code, internal, handle});
}

void misuse(State& s, const char* text) {
  if (s.misuse++ == 0) s.misuse_text = text;
}

void refuse(State& s, unsigned code, const char* text, unsigned handle) {
  push_error(s, code, handle);
  misuse(s, text);
}

}  // namespace fakehd

using namespace fakehd;

HdErrorInfo hdGetError(void) {
  Guard s;
  if (s->running && !in_servo(*s)) misuse(*s, "hdGetError outside the servo thread takes what belongs to it");
  if (s->errors.empty()) return {hd::kSuccess, 0, hd::kInvalidHandle};
  const HdErrorInfo youngest = s->errors.back();
  s->errors.pop_back();
  return youngest;
}

const char* hdGetErrorString(unsigned code) {
  for (const Text& text : kTexts) {
    if (text.code == code) return text.words;
  }
  return "fake: unknown error";
}

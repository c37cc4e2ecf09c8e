// Calibration by its three styles. Before it the pose stands still; the update makes it jump.
#include "fakehd_state.hpp"

namespace fakehd {
unsigned calibration_style(Calibration calibration) {
  switch (calibration) {
    case Calibration::encoder_reset:
      return hd::kStyleEncoderReset;
    case Calibration::inkwell:
      return hd::kStyleInkwell;
    default:
      return hd::kStyleAuto;
  }
}

bool in_inkwell(const State& s, const Session& d) {
  if (d.inkwell >= 0) return d.inkwell > 0;
  const DeviceScript& script = script_of(s, d);
  if (script.calibration != Calibration::inkwell || script.inkwell_at < 0) return false;
  return d.time >= script.inkwell_at && d.time < script.inkwell_at + script.inkwell_for;
}

unsigned calibration_status(const State& s, const Session& d) {
  if (d.calibrated) return hd::kCalibrationOk;
  const DeviceScript& script = script_of(s, d);
  switch (script.calibration) {
    case Calibration::inkwell:
      return in_inkwell(s, d) ? hd::kCalibrationNeedsUpdate : hd::kCalibrationNeedsManualInput;
    case Calibration::automatic:
      return d.time >= script.auto_after ? hd::kCalibrationNeedsUpdate : hd::kCalibrationNeedsManualInput;
    default:
      return hd::kCalibrationNeedsManualInput;  // the arm by hand to where its encoders are reset
  }
}

}  // namespace fakehd

using namespace fakehd;

unsigned hdCheckCalibration(void) {
  Guard s;
  const Session* d = current_session(*s);
  return d ? calibration_status(*s, *d) : hd::kCalibrationNeedsManualInput;
}

unsigned hdCheckCalibrationStyle(void) {
  Guard s;
  const Session* d = current_session(*s);
  return d ? calibration_style(script_of(*s, *d).calibration) : 0;
}

void hdUpdateCalibration(unsigned style) {
  Guard s;
  Session* d = current_session(*s);
  if (!d) return;
  const Calibration calibration = script_of(*s, *d).calibration;
  if (style != calibration_style(calibration)) {
    refuse(*s, hd::kInvalidValue, "a style of calibration that the device does not have", d->handle);
    return;
  }
  if (norm(d->applied) > 0) misuse(*s, "hdUpdateCalibration with a force on");
  const bool reset = calibration == Calibration::encoder_reset;
  if (reset && s->running) misuse(*s, "encoders reset while the scheduler runs");
  if (!reset && calibration_status(*s, *d) == hd::kCalibrationNeedsManualInput) {
    push_error(*s, hd::kInvalidOperation, d->handle);
    return;
  }
  d->calibrated = true;
}

void hdUpdateCalibrationMessage(unsigned) {
  Guard s;
  current_session(*s);
}

// hdBeginFrame and hdEndFrame: one frame for each device and tick, those of two devices may lie in each other.
#include "fakehd_state.hpp"

using namespace fakehd;

void hdBeginFrame(unsigned device) {
  Guard s;
  Session* d = open_session(*s, device);
  if (!d) return;
  if (d->frame_open) {
    refuse(*s, hd::kIllegalBegin, "a frame begun within one of the same device", device);
    return;
  }
  if (in_servo(*s) && d->frames_this_tick > 0 && is_enabled(*d, hd::kOneFrameLimit)) {
    refuse(*s, hd::kIllegalBegin, "two frames of one device in one tick", device);
    return;
  }
  s->current = device;
  d->frame_open = true;
  ++d->frames_this_tick;
  d->last = d->frame;
  d->frame = d->now;
  begin_force(*s, *d);
}

void hdEndFrame(unsigned device) {
  Guard s;
  Session* d = open_session(*s, device);
  if (!d) return;
  if (!d->frame_open) {
    refuse(*s, hd::kIllegalEnd, "a frame ended that was not begun", device);
    return;
  }
  d->frame_open = false;
  ++d->frames;
  send_force(*s, *d);
}

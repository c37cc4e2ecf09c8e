/* What a test can ask of the double of libHD, past HDAPI.

   The double is a model of documented behaviour, written from public facts. It is not the vendor's library, and nobody
   has compared it with that. What it shows about an adapter is that it follows the documents: nothing about real
   devices, their timing, their heat, or how a force feels.

   The script is a JSON text, or the path of one; README.md has its keys. It comes from fakehd_reset, or from the
   environment variable FAKEHD_SCRIPT at the first call of any hd function.

   Handles are those of hdInitDevice, and stay good for these functions after hdDisableDevice. A bad handle gives zeros.
   Metres, seconds, newtons. All functions may be called from all threads; none counts as a device call. */
#ifndef CRUMBLE_TESTS_FAKEHD_H
#define CRUMBLE_TESTS_FAKEHD_H

#define FAKEHD_PROBE __attribute__((visibility("default")))

#ifdef __cplusplus
extern "C" {
#endif

/* Stops the scheduler, closes every device, forgets every error and count, and takes a script; NULL: all defaults.
   0; -1 when the script is bad (hdInitDevice fails until the next reset) or when called from a callback. */
FAKEHD_PROBE int fakehd_reset(const char* script);
/* What is wrong with the script, "" if nothing. Good until the next reset. */
FAKEHD_PROBE const char* fakehd_script_error(void);
/* In manual mode, once hdStartScheduler has been called: n ticks on the caller's thread, which is the servo thread
   meanwhile. How many were run: fewer when hdStopScheduler came in between, 0 when the scheduler is off, or not manual,
   or when called from a callback. */
FAKEHD_PROBE long fakehd_run_ticks(long n);
/* Lets the running callback seem to take so much longer, s. The only time that passes within a tick in manual mode. */
FAKEHD_PROBE void fakehd_stall(double seconds);

/* The motors: what was asked for at the last hdEndFrame, and what the amplifiers made of it. N; the torque in mN m. */
FAKEHD_PROBE void fakehd_commanded_force(unsigned handle, double force[3]);
FAKEHD_PROBE void fakehd_applied_force(unsigned handle, double force[3]);
FAKEHD_PROBE void fakehd_last_torque(unsigned handle, double torque[3]);
/* Integral of the applied force, N s; its work on the hand, J; the largest norm, N; the largest change in a tick, N. */
FAKEHD_PROBE void fakehd_force_integral(unsigned handle, double integral[3]);
FAKEHD_PROBE double fakehd_work(unsigned handle);
FAKEHD_PROBE double fakehd_peak_force(unsigned handle);
FAKEHD_PROBE double fakehd_peak_slew(unsigned handle);
FAKEHD_PROBE double fakehd_temperature(unsigned handle);             /* of the warmest motor, 0 to 1 */
FAKEHD_PROBE void fakehd_set_temperature(unsigned handle, double t); /* of all motors */

/* The hand, as it is and not as it is reported: m, m/s. */
FAKEHD_PROBE void fakehd_position(unsigned handle, double position[3]);
FAKEHD_PROBE void fakehd_velocity(unsigned handle, double velocity[3]);
/* From now on the hand wants to be here, and is here at rest. */
FAKEHD_PROBE void fakehd_place(unsigned handle, const double position[3]);
FAKEHD_PROBE void fakehd_press_button(unsigned handle, unsigned mask); /* those held from now on; 0: none */
FAKEHD_PROBE void fakehd_inkwell(unsigned handle, int in);             /* from now on, whatever the script says */
/* Pulls the plug: HD_COMM_ERROR on each tick, and hdInitDevice fails. Put back, it needs hdInitDevice again. */
FAKEHD_PROBE void fakehd_unplug(unsigned handle);
FAKEHD_PROBE void fakehd_replug(unsigned handle);

FAKEHD_PROBE unsigned long fakehd_ticks(void);              /* begun since the reset; the first is number 1 */
FAKEHD_PROBE unsigned long fakehd_missed_ticks(void);       /* deadlines that the thread came too late for */
FAKEHD_PROBE unsigned long fakehd_rate(void);               /* Hz */
FAKEHD_PROBE unsigned long fakehd_frames(unsigned handle);  /* ended */
FAKEHD_PROBE unsigned fakehd_open_devices(void);
FAKEHD_PROBE int fakehd_is_open(unsigned handle);
FAKEHD_PROBE int fakehd_enabled(unsigned handle, unsigned capability);
FAKEHD_PROBE int fakehd_calibrated(unsigned handle);
FAKEHD_PROBE int fakehd_scheduler_running(void);
FAKEHD_PROBE unsigned fakehd_scheduled(void);               /* callbacks */
FAKEHD_PROBE unsigned fakehd_scheduler_starts(void);
/* hdDeploymentLicense came before hdInitDevice, with these words; NULL when it did not. Good until the next reset. */
FAKEHD_PROBE const char* fakehd_license_vendor(void);
FAKEHD_PROBE const char* fakehd_license_application(void);

FAKEHD_PROBE unsigned long fakehd_errors_pushed(void);
FAKEHD_PROBE unsigned fakehd_errors_pending(void);          /* pushed and not yet taken by hdGetError */
FAKEHD_PROBE void fakehd_push_error(unsigned code, int internal, unsigned handle);

/* Calls that broke a rule of the documents, and the first of these rules; "" when none was broken. */
FAKEHD_PROBE unsigned long fakehd_misuse(void);
FAKEHD_PROBE const char* fakehd_misuse_text(void);

#ifdef __cplusplus
}
#endif

#endif

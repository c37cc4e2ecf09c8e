/* What a C99 program sees of the API; c_client.c is compiled as C with -pedantic. */
#ifndef CRUMBLE_TESTS_C_CLIENT_H
#define CRUMBLE_TESTS_C_CLIENT_H

#include "crumble/crumble.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Size of a struct (field ""), or where a field lies in it. */
typedef struct c_layout {
  const char *type;
  const char *field;
  uint32_t bytes;
} c_layout;

/* Ends with a row of zeros. */
extern const c_layout c_layouts[];

/* Presses a tool 3 mm into the cube of `mesh`; the last vertical force, N, or NaN when a call failed. */
double c_press(crumble_mesh mesh);

#ifdef __cplusplus
}
#endif

#endif

/* crumble: real-time fracture of soft, brittle bodies with force feedback. This file is the whole C API and its manual;
 * docs/capi.md has a first program.
 *
 * Units. SI everywhere: metres, kilograms, seconds, newtons. Right-handed axes, +Y up. Quaternions are w, x, y, z.
 *
 * Results. Every function that can fail returns a crumble_result: CRUMBLE_OK or a negative CRUMBLE_E_ code. Nothing
 * aborts, prints or throws. crumble_last_error() tells the calling thread which function, field and value it was.
 * A call that fails changes no object and writes no output, with two exceptions that are said where they apply: a step
 * that fails writes zero force, and a buffer that is too small gets its needed size told.
 *
 * Handles. An object is named by a value that looks like a pointer and is none: it is looked up in a table, never
 * followed. Every function that takes a handle answers CRUMBLE_E_NULL for NULL, CRUMBLE_E_STALE_HANDLE for an object
 * that has been destroyed, CRUMBLE_E_BAD_HANDLE for anything else that is no handle of its kind, and CRUMBLE_E_BUSY
 * (see below). The comments of the functions list only what comes on top of these.
 *
 * Definitions. A struct whose first field is struct_size grows at its end from version to version. Fill it with its
 * _init function and sizeof, then set what you need. The library takes a shorter struct from an older program, with
 * defaults for the rest, and a longer one from a newer program as long as what it does not know is zero
 * (CRUMBLE_E_VERSION else). A size of 0 is CRUMBLE_E_UNINITIALIZED. Structs that the library fills carry struct_size
 * too: set it before the call.
 *
 * Threads. [any]: callable from every thread at any time. [one]: one thread at a time in one object, different objects
 * in parallel; a second thread in the same object is answered CRUMBLE_E_BUSY at once and never waits.
 */
#ifndef CRUMBLE_CRUMBLE_H
#define CRUMBLE_CRUMBLE_H

#include <stdint.h>

#if defined(__GNUC__)
#define CRUMBLE_API __attribute__((visibility("default")))
#else
#define CRUMBLE_API
#endif
/* Functions that may still change, or go, in any version; the others keep docs/versions.md. A program that must not use
 * them defines CRUMBLE_NO_EXPERIMENTAL: then calling one does not compile. */
#if defined(CRUMBLE_NO_EXPERIMENTAL) && defined(__clang__)
#define CRUMBLE_EXPERIMENTAL CRUMBLE_API __attribute__((unavailable("experimental")))
#elif defined(CRUMBLE_NO_EXPERIMENTAL) && defined(__GNUC__)
#define CRUMBLE_EXPERIMENTAL CRUMBLE_API __attribute__((error("experimental")))
#else
#define CRUMBLE_EXPERIMENTAL CRUMBLE_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Version ---------------------------------------------------------------------------------------------------- */

#define CRUMBLE_VERSION_MAJOR 0
#define CRUMBLE_VERSION_MINOR 1
#define CRUMBLE_VERSION_PATCH 0
/* of this header: major * 1000000 + minor * 1000 + patch */
#define CRUMBLE_VERSION_NUMBER (CRUMBLE_VERSION_MAJOR * 1000000 + CRUMBLE_VERSION_MINOR * 1000 + CRUMBLE_VERSION_PATCH)

typedef int32_t crumble_result;

/* CRUMBLE_VERSION_NUMBER of the library. [any] */
CRUMBLE_API uint32_t crumble_version(void);
/* The same as "major.minor.patch"; static text. [any] */
CRUMBLE_API const char *crumble_version_string(void);
/* One line for bug reports: version, source revision, compiler, kernels. Static text. [any] */
CRUMBLE_API const char *crumble_build_info(void);
/* The kernels, versions of the solver's inner loops for one processor family or another, that this library holds and
 * this processor runs: number `index`, from 0, slowest first, and NULL when there are no more. All give the same bits.
 * Static text. [any] */
CRUMBLE_API const char *crumble_kernel_name(uint32_t index);
/* Whether a program compiled with the header of version `header_version` (pass CRUMBLE_VERSION_NUMBER) can use this
 * library: same major version, and same minor version while the major one is 0. Else CRUMBLE_E_VERSION. [any] */
CRUMBLE_API crumble_result crumble_check_version(uint32_t header_version);

/* ---- Results ---------------------------------------------------------------------------------------------------- */

enum {
  CRUMBLE_OK = 0,
  CRUMBLE_E_NULL = -1,              /* a required pointer or handle is NULL */
  CRUMBLE_E_INVALID_VALUE = -2,     /* a number is NaN or infinite, or values contradict each other */
  CRUMBLE_E_OUT_OF_RANGE = -3,      /* a number is finite but not allowed */
  CRUMBLE_E_UNINITIALIZED = -4,     /* struct_size is 0 */
  CRUMBLE_E_VERSION = -5,           /* a struct, file or snapshot that this library does not know */
  CRUMBLE_E_BAD_HANDLE = -6,        /* no handle of this kind */
  CRUMBLE_E_STALE_HANDLE = -7,      /* its object has been destroyed */
  CRUMBLE_E_BUSY = -8,              /* another thread is in this object, or a loop that runs */
  CRUMBLE_E_IN_USE = -9,            /* another object needs this one */
  CRUMBLE_E_BUFFER_TOO_SMALL = -10, /* the needed size has been written */
  CRUMBLE_E_NO_MEMORY = -11,
  CRUMBLE_E_TOO_LARGE = -12, /* more than the library takes; found before memory is taken */
  CRUMBLE_E_TOO_COARSE = -13,
  CRUMBLE_E_EMPTY = -14,
  CRUMBLE_E_MESH = -15, /* an index out of range, a flat or inverted element, ... */
  CRUMBLE_E_MESH_OPEN = -16,
  CRUMBLE_E_MESH_ORIENTATION = -17,
  CRUMBLE_E_MESH_NONCONVEX = -18, /* given by no function any more: meshes need not be convex */
  CRUMBLE_E_DUPLICATE_NODE = -19,
  CRUMBLE_E_ISOLATED_NODE = -20,
  CRUMBLE_E_DT_TOO_LARGE = -21, /* time step */
  CRUMBLE_E_BAD_POSE = -22,     /* not finite, or not a rotation */
  CRUMBLE_E_IO = -23,
  CRUMBLE_E_FORMAT = -24,  /* a file that is not of the expected kind */
  CRUMBLE_E_CORRUPT = -25, /* truncated or damaged */
  CRUMBLE_E_DEVICE_LOST = -26,
  CRUMBLE_E_DIVERGED = -27, /* the body left the world and stands still until crumble_sim_reset */
  CRUMBLE_E_STATE = -28,    /* the call does not fit what the object is doing */
  CRUMBLE_E_UNSUPPORTED = -29,
  CRUMBLE_E_INTERNAL = -30 /* no thread from the system; else a defect: please report it with crumble_last_error() */
};

/* What went wrong in the calling thread's last call that failed, as "function: field and value"; "" before the first
 * one. Valid until that thread's next failing call. [any] */
CRUMBLE_API const char *crumble_last_error(void);
/* "CRUMBLE_E_NULL" and so on; "unknown" for a number that is no result. Static text. [any] */
CRUMBLE_API const char *crumble_result_name(crumble_result result);

/* ---- Memory and log --------------------------------------------------------------------------------------------- */

/* Where the library's memory comes from. Called by every thread that makes, changes or destroys objects, also by
 * several at once, and never in a step. Not asked for: words for people, file names and file buffers, threads, the
 * table of handles, and what other libraries take for themselves (FCL while a mesh tool is added, HDAPI, Boost). */
typedef struct crumble_memory_source {
  uint32_t struct_size;
  uint32_t reserved; /* keep 0 */
  /* `bytes` (above 0) at a multiple of `alignment`, a power of two up to 64; NULL when there are none: the call that
   * needs them answers CRUMBLE_E_NO_MEMORY. */
  void *(*take)(uint64_t bytes, uint64_t alignment, void *user);
  /* What take() gave, with the same bytes and alignment. */
  void (*give_back)(void *memory, uint64_t bytes, uint64_t alignment, void *user);
  void *user; /* given to both */
} crumble_memory_source;

/* Since the source was set. */
typedef struct crumble_memory_info {
  uint32_t struct_size;
  uint32_t reserved;     /* 0 */
  uint64_t blocks;       /* taken and not given back */
  uint64_t bytes;        /* in these */
  uint64_t most_bytes;   /* that there ever were */
  uint64_t longest_free; /* bytes that crumble_memory_use_block could still give at once; 0 without it */
} crumble_memory_info;

/* The host's functions from here on; NULL: those of the C++ run time again. CRUMBLE_E_IN_USE (an object is alive: set
 * it before the first is made), _NULL (take, give_back), _UNINITIALIZED, _VERSION. [any] */
CRUMBLE_API crumble_result crumble_memory_set_source(const crumble_memory_source *source);
/* The library has these `bytes` and no more: it gives them out by itself, first fit. `memory` stays the host's and must
 * live until another source is set. How much a body needs: crumble_memory_get_info tells it of one that is there.
 * CRUMBLE_E_NULL, _OUT_OF_RANGE (fewer than 4096), _IN_USE. [any] */
CRUMBLE_EXPERIMENTAL crumble_result crumble_memory_use_block(void *memory, uint64_t bytes);
/* CRUMBLE_E_UNINITIALIZED, _VERSION (struct_size). [any] */
CRUMBLE_API crumble_result crumble_memory_get_info(crumble_memory_info *info);

enum {
  CRUMBLE_LOG_ERROR = 1,   /* what crumble_last_error says of a call that failed */
  CRUMBLE_LOG_WARNING = 2, /* something works, but not as asked for: damping that a device cannot give, ... */
  CRUMBLE_LOG_NOTE = 3     /* which device was opened, how a loop's thread is scheduled, ... */
};

/* `text` is one line, UTF-8, valid during the call. It is called in the thread that made the call it tells of, before
 * that returns; never in a step, a tick, or a read or write of a device, and by no thread of the library's own. It may
 * call this API. */
typedef void (*crumble_log_function)(uint32_t level, const char *text, void *user);

/* What the library has to say goes to `function` from here on; NULL (default): nowhere. Other threads may still be in
 * the one before when this returns. [any] */
CRUMBLE_API crumble_result crumble_log_set(crumble_log_function function, void *user);

/* ---- Arrays ----------------------------------------------------------------------------------------------------- */

enum { CRUMBLE_SCALAR_FLOAT64 = 1, CRUMBLE_SCALAR_FLOAT32 = 2, CRUMBLE_SCALAR_UINT32 = 3, CRUMBLE_SCALAR_UINT8 = 4 };

/* A look into an object's own memory: `count` rows of `components` scalars, one row every `stride` bytes. Read only.
 * This struct never changes its size. */
typedef struct crumble_view {
  const void *data;
  uint64_t count;
  uint32_t stride;
  uint32_t components;
  uint32_t scalar_type; /* CRUMBLE_SCALAR_ */
  uint32_t reserved;    /* 0 */
} crumble_view;

/* What crumble_mesh_get_view, crumble_mesh_copy, crumble_sim_get_view and crumble_sim_copy can be asked for.
 * Row i of an array per node belongs to node i, and so on: every index in this API counts rows from 0. */
enum {
  /* Of a mesh. */
  CRUMBLE_ARRAY_REST_POSITIONS = 1, /* (nodes, 3) float64, m */
  CRUMBLE_ARRAY_NODE_KINDS = 2,     /* (nodes) uint8: 0 corner, 1 crease, 2 surface, 3 inside */
  CRUMBLE_ARRAY_NODE_VOLUMES = 3,   /* (nodes) float64, m^3: a quarter of every tetrahedron around the node */
  CRUMBLE_ARRAY_TETRAHEDRA = 4,     /* (tetrahedra, 4) uint32 nodes; positive volume in this order */
  CRUMBLE_ARRAY_SPRINGS = 5,        /* (springs, 2) uint32 nodes, first < second, ascending */
  CRUMBLE_ARRAY_BOUNDARY = 6,       /* (triangles, 3) uint32 nodes, counter-clockwise from outside */
  /* Of a simulation, as the last step left it. The library keeps one array per axis; POSITIONS and VELOCITIES put the
   * three together and exist as copies only. The first view or copy of either after a step fetches it from the solver,
   * once for all nodes and axes. */
  CRUMBLE_ARRAY_POSITIONS = 16,   /* (nodes, 3) float64, m; copy only */
  CRUMBLE_ARRAY_POSITIONS_X = 17, /* (nodes) float64, m */
  CRUMBLE_ARRAY_POSITIONS_Y = 18,
  CRUMBLE_ARRAY_POSITIONS_Z = 19,
  CRUMBLE_ARRAY_VELOCITIES = 20,   /* (nodes, 3) float64, m/s; copy only */
  CRUMBLE_ARRAY_VELOCITIES_X = 21, /* (nodes) float64, m/s */
  CRUMBLE_ARRAY_VELOCITIES_Y = 22,
  CRUMBLE_ARRAY_VELOCITIES_Z = 23,
  CRUMBLE_ARRAY_INTACT = 24,         /* (springs) uint8: 1 intact, 0 cut */
  CRUMBLE_ARRAY_NEW_CUTS = 25,       /* uint32 springs that the last step cut, ascending */
  CRUMBLE_ARRAY_NODE_FRAGMENTS = 26, /* (nodes) uint32 fragment of each node; CRUMBLE_NONE: removed */
  /* Of a simulation, as the last crumble_sim_extract_surface left it, CRUMBLE_E_STATE before the first one; and of a
   * reader, as the last crumble_reader_update left it. */
  CRUMBLE_ARRAY_SURFACE_POSITIONS = 32,      /* (vertices, 3) float64, m */
  CRUMBLE_ARRAY_SURFACE_REST_POSITIONS = 33, /* (vertices, 3) float64, m: the same points in the body at rest */
  CRUMBLE_ARRAY_SURFACE_TRIANGLES = 34,      /* (triangles, 3) uint32 vertices, counter-clockwise; skin first */
  CRUMBLE_ARRAY_SURFACE_NORMALS = 35,        /* (triangles, 9) float32: a unit normal for each of the 3 corners */
  CRUMBLE_ARRAY_SURFACE_FRAGMENTS = 36,      /* (triangles) uint32 fragment */
  CRUMBLE_ARRAY_SURFACE_TETRAHEDRA = 37,     /* (triangles) uint32 tetrahedron that the triangle was cut from */
  /* Of a reader only; it also has POSITIONS (copy only), POSITIONS_X, _Y, _Z, INTACT and NODE_FRAGMENTS. */
  CRUMBLE_ARRAY_SURFACE_SKIN_SOURCES = 38,      /* (skin triangles) uint32 triangle of CRUMBLE_ARRAY_BOUNDARY that it is
                                                   a part of */
  CRUMBLE_ARRAY_SURFACE_CHANGED_TRIANGLES = 39, /* uint32 triangles whose vertices, place (skin or interior) or fragment
                                                   the last update changed */
  CRUMBLE_ARRAY_SURFACE_CHANGED_VERTICES = 40   /* uint32 vertices whose rest position it changed; positions and
                                                   normals change with every update */
};

/* In place of an index: there is none. */
#define CRUMBLE_NONE 0xffffffffu

/* ---- Meshes ----------------------------------------------------------------------------------------------------- */

/* The tetrahedral mesh of a body at rest. Never changes. Bodies rest on y = 0, centred in x and z. */
typedef struct crumble_mesh_t *crumble_mesh;

enum { CRUMBLE_SHAPE_BOX = 0, CRUMBLE_SHAPE_SPHERE = 1, CRUMBLE_SHAPE_CYLINDER = 2 };

/* A body to be meshed by close-packed bubbles. */
typedef struct crumble_mesh_def {
  uint32_t struct_size;
  uint32_t shape;         /* CRUMBLE_SHAPE_; default: box */
  uint32_t surface_nodes; /* exact number of nodes on the surface and ... */
  uint32_t inside_nodes;  /* ... inside: both, or 0 and 0 (default) for what comes out by itself */
  double size[3];         /* box: edge lengths, m; default 0.03 each */
  double radius;          /* sphere and cylinder, m; default 0.02 */
  double height;          /* cylinder (upright), m; default 0.03 */
  double spacing;         /* distance wanted between neighbouring nodes, m; default 0.0044 */
} crumble_mesh_def;

/* The bodies of the paper, with its numbers of nodes on the surface + inside. */
enum {
  CRUMBLE_PAPER_CUBE = 0,         /* 30 mm cube, 306 + 294 */
  CRUMBLE_PAPER_SLAB = 1,         /* 30 x 10 x 30 mm, 382 + 314 */
  CRUMBLE_PAPER_GLOBE = 2,        /* radius 20 mm, 305 + 370 (the paper's two numbers read as swapped) */
  CRUMBLE_PAPER_GLOBE_LITERAL = 3 /* the same with 370 + 305, as printed */
};

typedef struct crumble_mesh_info {
  uint32_t struct_size;
  uint32_t node_count;
  uint32_t surface_node_count;
  uint32_t spring_count;
  uint32_t tetrahedron_count;
  uint32_t boundary_triangle_count;
  double volume; /* m^3 */
} crumble_mesh_info;

/* Defaults. `struct_size`: sizeof(crumble_mesh_def).
 * CRUMBLE_E_NULL, _UNINITIALIZED (size 0), _VERSION (a size that no version has). [any] */
CRUMBLE_API crumble_result crumble_mesh_def_init(crumble_mesh_def *def, uint32_t struct_size);
/* Meshes a shape; the same bits on every machine. Takes tenths of a second for the paper's bodies.
 * CRUMBLE_E_INVALID_VALUE and _OUT_OF_RANGE (a field; counts too far from what comes out by itself), _TOO_COARSE (the
 * text names the largest usable spacing), _TOO_LARGE (above 5 million nodes), _MESH (no valid mesh came out),
 * _NO_MEMORY. [any] */
CRUMBLE_API crumble_result crumble_mesh_create(const crumble_mesh_def *def, crumble_mesh *mesh);
/* One of the paper's bodies, CRUMBLE_PAPER_. CRUMBLE_E_OUT_OF_RANGE, _NO_MEMORY. [any] */
CRUMBLE_API crumble_result crumble_mesh_create_paper(uint32_t body, crumble_mesh *mesh);
/* A mesh of your own. `positions`: (node_count, 3), m. `tetrahedra`: (tetrahedron_count, 4) nodes, each with positive
 * volume: seen from its fourth corner the first three go counter-clockwise. Both are copied.
 * CRUMBLE_E_EMPTY, _TOO_LARGE (a count above 2^31 - 1), _INVALID_VALUE (a position), _MESH (index, flat or inverted
 * tetrahedron, face of more than two), _DUPLICATE_NODE, _ISOLATED_NODE, _NO_MEMORY; the text names the first bad
 * index. [any] */
CRUMBLE_API crumble_result crumble_mesh_create_from_tets(const double *positions, uint32_t node_count,
                                                         const uint32_t *tetrahedra, uint32_t tetrahedron_count,
                                                         crumble_mesh *mesh);
/* Writes it as a legacy VTK file (unstructured grid, m, node kinds as point data), which ParaView and meshio read.
 * `path` is UTF-8; the file is replaced only when all of it is written. CRUMBLE_E_NULL, _IO, _NO_MEMORY. [one] */
CRUMBLE_API crumble_result crumble_mesh_save_vtk(crumble_mesh mesh, const char *path);
/* NULL is allowed and does nothing. Simulations made from the mesh keep what they need. [one] */
CRUMBLE_API crumble_result crumble_mesh_destroy(crumble_mesh mesh);
/* CRUMBLE_E_UNINITIALIZED, _VERSION (struct_size). [one] */
CRUMBLE_API crumble_result crumble_mesh_get_info(crumble_mesh mesh, crumble_mesh_info *info);
/* Array `which` of the mesh group of CRUMBLE_ARRAY_, without a copy; valid until the mesh is destroyed.
 * CRUMBLE_E_OUT_OF_RANGE (no such array of a mesh). [one] */
CRUMBLE_API crumble_result crumble_mesh_get_view(crumble_mesh mesh, uint32_t which, crumble_view *view);
/* The same array, rows packed, into `dst` of `dst_bytes`. `needed` receives the bytes it takes and may be NULL; with
 * `dst` NULL the call only asks for it. CRUMBLE_E_OUT_OF_RANGE, _BUFFER_TOO_SMALL (`needed` is written, `dst` is
 * not). [one] */
CRUMBLE_API crumble_result crumble_mesh_copy(crumble_mesh mesh, uint32_t which, void *dst, uint64_t dst_bytes,
                                             uint64_t *needed);

/* ---- Simulations ------------------------------------------------------------------------------------------------ */

/* One body, the tools and walls that touch it, and the step that a servo loop calls. */
typedef struct crumble_sim_t *crumble_sim;

enum { CRUMBLE_MASS_LUMPED = 0, CRUMBLE_MASS_EQUAL = 1 };
enum {
  CRUMBLE_POLICY_GUARD = 0,    /* raise the drag of nodes for which tau is too long: stable everywhere */
  CRUMBLE_POLICY_SUBSTEP = 1,  /* divide the step: the exact model, up to 64 substeps */
  CRUMBLE_POLICY_ERROR = 2,    /* refuse such a tau */
  CRUMBLE_POLICY_UNCHECKED = 3 /* the paper's way: nothing */
};
enum { CRUMBLE_CONTACT_NEAREST_SURFACE = 0, CRUMBLE_CONTACT_ALONG_MOTION = 1 };
enum {
  CRUMBLE_PRECISION_FLOAT64 = 0,
  CRUMBLE_PRECISION_FLOAT32 = 1 /* faster; arrays are float64 all the same */
};

enum {
  CRUMBLE_CUT_TEST_WITH_FORCES = 0, /* where the next forces are worked out: costs nothing */
  CRUMBLE_CUT_TEST_AFTER_MOVE = 1   /* on the new positions, as in the paper: another pass over the springs */
};

enum {
  CRUMBLE_DRAG_FRAGMENT = 0, /* the rigid motion of a node's fragment: loose pieces fall and tumble */
  CRUMBLE_DRAG_ROOM = 1      /* the room: the paper's way */
};

/* Runs task(data, i) for every i from 0 to count - 1, in any order and on any threads, and returns when all are done.
 * What the caller wrote before, the tasks see; what they wrote, the caller sees. `context` is the host's own. */
typedef void (*crumble_parallel_for)(void *context, uint32_t count, void (*task)(void *data, uint32_t index),
                                     void *data);

/* What a simulation is, apart from its mesh, tools, walls and fixed nodes. The defaults are a tofu of the paper's best
 * parameters on a smooth floor, with the library's best behaviour. */
typedef struct crumble_sim_def {
  uint32_t struct_size;
  uint32_t floor;            /* 1 (default): a floor without friction at y = 0; 0: none */
  double gravity[3];         /* m/s^2; default 0, -9.81, 0 */
  double stiffness;          /* k of every spring, N/m; > 0; default 30 */
  double damping_ratio;      /* alpha of the paper's Eq (2); >= 0; default 30 */
  double length_limit;       /* l_p of Eq (8): springs longer than this times their rest length are cut; > 1; 1.3 */
  double mass;               /* of the body, kg; > 0; default 0.03 */
  uint32_t mass_rule;        /* CRUMBLE_MASS_: by the volume around each node (default), or the same for all */
  uint32_t time_step_policy; /* CRUMBLE_POLICY_; default guard */
  double tau;                /* time that a step advances, s; (0, 0.01]; default 0.001 */
  uint32_t iterations;       /* of Eqs (3) and (4) per step, each advancing tau; above 1 only unchecked; default 1 */
  uint32_t contact_rule;     /* CRUMBLE_CONTACT_: how nodes leave a tool; default nearest surface */
  double cut_fade;           /* time in which the force of a cut spring goes to 0, s; [0, 1]; default 0.004 */
  uint32_t mean_force;       /* 1: report the mean of the last five forces, Eq (7); default 0 */
  uint32_t reserved;         /* keep 0 */
  uint32_t precision;        /* CRUMBLE_PRECISION_: how the solver holds its numbers; default float64 */
  /* The rest changes no bit of what comes out. */
  uint32_t threads;   /* that share a step of a body of 50 000 springs or more; [1, 64]; default 1 */
  const char *kernel; /* of crumble_kernel_name; copied; NULL (default): $CRUMBLE_KERNEL, else the fastest */
  crumble_parallel_for host_threads; /* the host's threads share a step instead of `threads` of ours; default NULL */
  void *host_context;                /* given to host_threads */
  /* These do change what comes out. */
  uint32_t cut_test;           /* CRUMBLE_CUT_TEST_: where springs are found too long; default with forces */
  uint32_t drag_frame;         /* CRUMBLE_DRAG_: what the drag of Eq (1) brakes against; default the fragment */
  uint32_t surface_samples;    /* 1 (default): thin tools meet the surface between nodes too; 0: nodes alone */
  uint32_t ball_contact;       /* 1 (default): fragments and the lips of cracks touch each other */
  double ball_static_friction; /* between fragments, as for tools; default 0.5 */
  double ball_dynamic_friction; /* default 0.5 */
  double spring_damping;        /* of a damper along each spring, N s/m; >= 0; default 0 */
  uint32_t energy_audit; /* 1: keep the books for crumble_sim_get_energy, which takes four more passes over the springs;
                            default 0. Changes no bit of what comes out */
  uint32_t reserved_2;   /* keep 0 */
} crumble_sim_def;

/* Where a tool is. This struct never changes its size. */
typedef struct crumble_pose {
  double position[3];    /* of the tool's origin, m */
  double orientation[4]; /* unit quaternion w, x, y, z; made unit again if its length is within 0.001 of 1 */
} crumble_pose;

/* Writes a point of a convex set that lies farthest along `direction`, a unit vector, both in the tool's frame, m. It
 * is called while the tool is added and in steps, also by several threads at once; it gives the same point for the same
 * direction, does not block and calls nothing of this API. `context` is the host's own. */
typedef void (*crumble_support_function)(void *context, const double direction[3], double point[3]);

enum {
  CRUMBLE_TOOL_STICK = 0,
  CRUMBLE_TOOL_BAR = 1,  /* a plate is a flat bar */
  CRUMBLE_TOOL_MESH = 2, /* any closed surface, convex or not, in one part or several */
  CRUMBLE_TOOL_BALL = 3,
  CRUMBLE_TOOL_CAPSULE = 4,
  CRUMBLE_TOOL_CONE = 5,
  CRUMBLE_TOOL_BLADE = 6,  /* a knife with its edge looking down (-Y) */
  CRUMBLE_TOOL_SUPPORT = 7 /* a convex set known by its support function; a recording of it cannot be loaded */
};

/* What a hand moves: a solid in a frame of its own, which offset and pose put into the scene. */
typedef struct crumble_tool_def {
  uint32_t struct_size;
  uint32_t shape;            /* CRUMBLE_TOOL_; default: the paper's round stick of 8 mm diameter and 5 cm length */
  double radius;             /* stick: prism on a regular polygon in a circle of this radius, axis +Z, m; 0.004.
                                Ball, capsule (of the cylinder and its round ends), cone (of its flat end at +Z) */
  double length;             /* stick; capsule: its cylinder, without the ends, along Z; cone: from the point at -Z to
                                the flat end, m; default 0.05 */
  double size[3];            /* bar: edge lengths about the origin, m; default 0.006, 0.006, 0.05.
                                Blade: thickness, height and length, about the origin */
  uint32_t sides;            /* stick: 3 to 4096; default 16; one looks down (-Y) when even */
  uint32_t vertex_count;     /* mesh: rows of `vertices` */
  uint32_t triangle_count;   /* mesh: rows of `triangles` */
  uint32_t reserved;         /* keep 0 */
  double static_friction;    /* Coulomb coefficients, 0 <= dynamic <= static; default 0; the paper has 3.0 ... */
  double dynamic_friction;   /* ... and 1.5 */
  const double *vertices;    /* mesh: (vertex_count, 3), m; copied */
  const uint32_t *triangles; /* mesh: (triangle_count, 3) vertices, closed, counter-clockwise from outside; copied */
  crumble_pose offset;       /* from the tool's frame to that of the hand, whose pose moves it; default: none */
  double bevel;              /* blade: height, from the edge up, over which it grows to its full thickness, m; up to
                                size[1]; 0 (default): all of it, a wedge */
  uint32_t auto_orient;      /* mesh: 1 turns one that faces inward as a whole inside out; default 0: it is refused */
  uint32_t reserved_2;       /* keep 0 */
  crumble_support_function support; /* support */
  void *support_context;            /* given to `support`; must outlive the simulation */
  double inside[3];                 /* support: any point well within the set, in the tool's frame, m; default 0 */
} crumble_tool_def;

/* A half-space that the body stays out of: normal . x >= offset on the body's side. */
typedef struct crumble_wall_def {
  uint32_t struct_size;
  uint32_t reserved;       /* keep 0 */
  double normal[3];        /* unit; default 0, 1, 0 */
  double offset;           /* m; default 0 */
  double static_friction;  /* as for tools; default 0 */
  double dynamic_friction; /* default 0 */
} crumble_wall_def;

/* What the body does to a tool, in scene axes. This struct never changes its size. */
typedef struct crumble_wrench {
  double force[3];  /* N */
  double torque[3]; /* N m, about the tool's origin */
} crumble_wrench;

/* What a step had to do; the force is valid all the same. */
enum {
  CRUMBLE_STEP_TOOL_JUMPED = 1,       /* a tool or attachment moved farther than a step can follow */
  CRUMBLE_STEP_CONTACT_SUSPENDED = 2, /* a tool that jumped, or began inside the body, has not been outside since */
  CRUMBLE_STEP_GUARDED = 4,           /* CRUMBLE_POLICY_GUARD raised the drag of some nodes */
  CRUMBLE_STEP_DROPPED = 8            /* only from crumble_sim_advance: steps were left out for want of time */
};

/* The last step. */
typedef struct crumble_step_info {
  uint32_t struct_size;
  int32_t status;    /* what crumble_sim_step returned: CRUMBLE_OK, _BAD_POSE or _DIVERGED */
  uint64_t step;     /* steps done since the start */
  double time;       /* simulated seconds */
  uint32_t flags;    /* CRUMBLE_STEP_ bits */
  uint32_t contacts; /* nodes that tools hold */
  uint32_t new_cuts; /* springs cut in this step */
  uint32_t bad_node; /* with _DIVERGED: the first node that left the world */
} crumble_step_info;

/* Sums since the start. */
typedef struct crumble_counters {
  uint32_t struct_size;
  uint32_t reserved;        /* 0 */
  uint64_t guarded_nodes;   /* nodes whose drag the guard raised: a property of body and tau */
  uint64_t cuts;            /* springs */
  uint64_t tool_jumps;      /* steps with CRUMBLE_STEP_TOOL_JUMPED, per tool */
  uint64_t suspended_steps; /* steps with CRUMBLE_STEP_CONTACT_SUSPENDED */
  uint64_t bad_poses;       /* steps refused with CRUMBLE_E_BAD_POSE */
  uint64_t dropped_events;  /* of steps with more than 65536 events */
  uint64_t asleep;          /* fragments, now */
  uint64_t woken;           /* fragments, by tools and by fragments that hit them */
  uint64_t removed;         /* fragments */
  uint64_t removed_nodes;
  uint64_t dropped_steps; /* by crumble_sim_advance, for want of time */
} crumble_counters;

/* What came of several steps. */
typedef struct crumble_advance_info {
  uint32_t struct_size;
  uint32_t flags;    /* CRUMBLE_STEP_ bits of all of them */
  uint32_t steps;    /* done */
  uint32_t dropped;  /* steps left out: simulated time lags by so many */
  uint32_t new_cuts; /* springs */
  uint32_t reserved; /* 0 */
  double seconds;    /* wall time that they took, s */
  double time;       /* simulated, since the start, s */
} crumble_advance_info;

/* The books of the energy audit, J: stored = tool_work + external_work - dissipated - cut, since the start. */
typedef struct crumble_energy {
  uint32_t struct_size;
  uint32_t reserved;        /* 0 */
  double stored;            /* in springs and motion, J, now */
  double tool_work;         /* by tools and walls, J */
  double external_work;     /* by gravity, node forces, fragments that push each other, changes of the definition, J */
  double dissipated;        /* by drag and damping, J */
  double cut;               /* gone with cut springs, J */
  double gain_max_relative; /* greatest growth by the solver alone in a substep over stored energy; 1e-15 is rounding */
} crumble_energy;

/* Wall time of each stage of the last step, s. */
typedef struct crumble_profile {
  uint32_t struct_size;
  uint32_t reserved; /* 0 */
  double move_tool;
  double find_contacts;
  double project_contacts;
  double solve_network;
  double cut_springs;
  double sum_reaction;
  double finish_step;
  double touch_fragments; /* between project_contacts and solve_network */
} crumble_profile;

/* How the body was laid out for the solver. Springs that repeat along the rows of a crystal stand in segments, the
 * others in batches of 8 that share no node. */
typedef struct crumble_sim_info {
  uint32_t struct_size;
  uint32_t kernel;              /* in use; a number for crumble_kernel_name */
  uint32_t springs_in_segments; /* of the mesh's spring_count; the others stand in batches */
  uint32_t lanes;               /* places for springs, filled or not: spring_count / lanes is the lane use */
  uint32_t segments;
  uint32_t batches;
  uint32_t partitions; /* pieces that threads can share: so many work at once, at most */
  uint32_t sorted;     /* 1: the solver numbers the nodes its own way, since their order was not a good one */
} crumble_sim_info;

/* How a node is held. */
enum {
  CRUMBLE_HELD_FRESH = 0,    /* came to lie in a tool at the end of the step: no force yet */
  CRUMBLE_HELD_STICKING = 1, /* goes where its holder goes */
  CRUMBLE_HELD_SLIDING = 2,  /* along the holder's surface, under dynamic friction */
  CRUMBLE_HELD_ATTACHED = 4  /* by an attachment: for good */
};

/* One node that is held, as the last step left it. This struct never changes its size. */
typedef struct crumble_contact {
  uint32_t node;
  uint32_t holder;    /* index of the tool; behind the tools, of the attachment; CRUMBLE_NONE: a wall */
  uint32_t state;     /* CRUMBLE_HELD_ */
  uint32_t reserved;  /* 0 */
  double point[3];    /* where it was held, m */
  double normal[3];   /* unit, from the holder into the body */
  double reaction[3]; /* force that the holder puts on the node, N; a tool feels the opposite */
} crumble_contact;

/* One contact of a local model; crumble_local_model_evaluate reads it. This struct never changes its size. */
typedef struct crumble_local_contact {
  double arm[3];       /* from the tool's origin to the node, m */
  double normal[3];    /* unit, from the tool into the body */
  double force[3];     /* of springs and outer forces on the node, N */
  double inner[3];     /* of springs to nodes of the same tool, N: turns with the tool */
  double stiffness[9]; /* - d force / d node, rows of 3, N/m */
  double grip;         /* the tangential force may be so many times the normal one */
} crumble_local_contact;

#define CRUMBLE_LOCAL_CONTACTS 96

/* What the body does to a tool near where it is, for a loop that runs faster than the steps: no pointers, so it may be
 * copied and handed to another thread. This struct never changes its size. */
typedef struct crumble_local_model {
  crumble_pose at;        /* where the tool is */
  crumble_wrench wrench;  /* there; what the next step gives if the tool stays */
  double jacobian[36];    /* d(force, torque) / d(translation, rotation vector), rows of 6; symmetric, never positive */
  double stiffness[9];    /* - d force / d translation, rows of 3, N/m: what a servo loop has to damp */
  double radius;          /* wrench + jacobian x motion holds while no contact moves farther than this, m; <= 0.0005 */
  double held_drag;       /* of the nodes that the tool holds, N s/m; in no force */
  uint32_t fracture;      /* 1: the last step cut springs, so a fall of the force is real */
  uint32_t contact_count; /* nodes that the tool holds and that press on it */
  uint32_t listed;        /* of these in `contacts`; the others are in `rest` */
  uint32_t reserved;      /* 0 */
  crumble_wrench rest;    /* of attached nodes, and of contacts beyond the list ... */
  double rest_jacobian[36]; /* ... by this ... */
  double rest_normal[3];  /* ... and lets go as a whole when it would pull along this; 0, 0, 0: never */
  crumble_local_contact contacts[CRUMBLE_LOCAL_CONTACTS];
} crumble_local_model;

/* What a host may make of a fragment. */
enum {
  CRUMBLE_FRAGMENT_ACTIVE = 0,
  CRUMBLE_FRAGMENT_ASLEEP = 1, /* stands still, weightless, until a tool touches it; walls do not push it */
  CRUMBLE_FRAGMENT_REMOVED = 2 /* nothing moves or touches it, no surface shows it; for good */
};

typedef struct crumble_surface_info {
  uint32_t struct_size;
  uint32_t vertex_count;
  uint32_t triangle_count;
  uint32_t skin_triangle_count; /* the first triangles: the body's outside; the others were laid open by cracks */
  uint32_t fragment_count;
  uint32_t reserved; /* 0 */
} crumble_surface_info;

/* Defaults. `struct_size`: sizeof of the struct.
 * CRUMBLE_E_NULL, _UNINITIALIZED (size 0), _VERSION (a size that no version has), _NO_MEMORY (in the first call of a
 * process). [any] */
CRUMBLE_API crumble_result crumble_sim_def_init(crumble_sim_def *def, uint32_t struct_size);
CRUMBLE_API crumble_result crumble_tool_def_init(crumble_tool_def *def, uint32_t struct_size);
CRUMBLE_API crumble_result crumble_wall_def_init(crumble_wall_def *def, uint32_t struct_size);

/* A simulation of a body at rest, without tools and fixed nodes. `def` may be NULL: defaults. The mesh may be destroyed
 * afterwards.
 * CRUMBLE_E_INVALID_VALUE and _OUT_OF_RANGE (the text names the field), _UNINITIALIZED, _VERSION, _DT_TOO_LARGE (tau),
 * _UNSUPPORTED (a kernel that is not there; the text names those that are), _INTERNAL (the system gives no more
 * threads), _NO_MEMORY. [one] in the mesh */
CRUMBLE_API crumble_result crumble_sim_create(crumble_mesh mesh, const crumble_sim_def *def, crumble_sim *sim);
/* NULL is allowed and does nothing. [one] */
CRUMBLE_API crumble_result crumble_sim_destroy(crumble_sim sim);

/* Set-up and change. The functions of this group say what the simulation is. Before the first step, without readers and
 * loops, they build it anew. Later they change it between two steps: all that moves stays as it is and where it is, and
 * goes on under the new rule; a recording keeps the change, snapshots from before it fit no more. What cannot change
 * then is said (CRUMBLE_E_STATE): tau, iterations, precision, the number of tools, attachments. Takes as long as
 * crumble_sim_create. All: CRUMBLE_E_NO_MEMORY. While a loop runs: crumble_loop_configure, _set_tool, _set_friction. */

/* What the simulation was made with, changed by what was called since; `kernel` is static text.
 * CRUMBLE_E_UNINITIALIZED, _VERSION. At any time. [one] */
CRUMBLE_API crumble_result crumble_sim_get_def(crumble_sim sim, crumble_sim_def *def);
/* Another definition: material, gravity, floor, step. Errors as crumble_sim_create; _STATE (see above). [one] */
CRUMBLE_API crumble_result crumble_sim_configure(crumble_sim sim, const crumble_sim_def *def);
/* Tools count from 0 in the order they are added; `index` receives the number and may be NULL. The first pose of the
 * first step places a tool.
 * CRUMBLE_E_STATE (stepped, readers, loops), _INVALID_VALUE (also of a support function whose points no convex set
 * has), _OUT_OF_RANGE, _UNINITIALIZED, _VERSION, _NULL (arrays of a mesh, a support function), _BAD_POSE (offset); for
 * a mesh also _MESH (fewer than 4 triangles, index, position not finite, surfaces that cross; the text names the first
 * bad one), _MESH_OPEN, _MESH_ORIENTATION, _TOO_LARGE. [one] */
CRUMBLE_API crumble_result crumble_sim_add_tool(crumble_sim sim, const crumble_tool_def *def, uint32_t *index);
/* Another tool in the place of number `tool`. One whose solid or offset changes lets go of the body, and touches it
 * again once it has been outside. Errors as crumble_sim_add_tool; _OUT_OF_RANGE (no such tool). [one] */
CRUMBLE_API crumble_result crumble_sim_set_tool(crumble_sim sim, uint32_t tool, const crumble_tool_def *def);
/* Friction of a tool, as in crumble_tool_def; what it holds it goes on holding. CRUMBLE_E_INVALID_VALUE, _OUT_OF_RANGE
 * (no such tool; friction). [one] */
CRUMBLE_API crumble_result crumble_sim_set_friction(crumble_sim sim, uint32_t tool, double static_friction,
                                                    double dynamic_friction);
/* Nodes that go where a frame goes: a clamp, a hand that never lets go. Like a tool it is moved by a pose in each step,
 * which stands behind those of the tools and of the attachments before it; `index` receives its number among the
 * attachments, from 0, and may be NULL. The nodes keep the places in the frame that they have at its first pose.
 * `nodes` (count) are copied. CRUMBLE_E_NULL, _EMPTY (count 0), _OUT_OF_RANGE (no such node), _STATE (a node that is
 * fixed or attached already; stepped, readers, loops). [one] */
CRUMBLE_API crumble_result crumble_sim_add_attachment(crumble_sim sim, const uint32_t *nodes, uint32_t count,
                                                      uint32_t *index);
/* CRUMBLE_E_INVALID_VALUE, _OUT_OF_RANGE (not a unit normal; friction), _UNINITIALIZED, _VERSION. [one] */
CRUMBLE_API crumble_result crumble_sim_add_wall(crumble_sim sim, const crumble_wall_def *def);
/* Another wall in the place of number `wall`; they count from 0 in the order they were added, behind the floor, if
 * there is one, which is number 0. Nodes behind it are put before it in the next step.
 * CRUMBLE_E_OUT_OF_RANGE (also: no such wall), _INVALID_VALUE, _UNINITIALIZED, _VERSION. [one] */
CRUMBLE_API crumble_result crumble_sim_set_wall(crumble_sim sim, uint32_t wall, const crumble_wall_def *def);
/* The nodes that never move: `nodes` (count) replaces those named before. `nodes` may be NULL with count 0. A node that
 * is fixed in mid-run stops where it is.
 * CRUMBLE_E_OUT_OF_RANGE (no such node). [one] */
CRUMBLE_API crumble_result crumble_sim_fix_nodes(crumble_sim sim, const uint32_t *nodes, uint32_t count);
/* The same with all nodes whose rest position has y <= height (m): what stands on the table.
 * CRUMBLE_E_INVALID_VALUE. [one] */
CRUMBLE_API crumble_result crumble_sim_fix_below(crumble_sim sim, double height);
/* Fixes more nodes: those that lie at rest in the box from corner `low` to corner `high`, (3) each, m, its faces
 * included. CRUMBLE_E_NULL, _INVALID_VALUE, _OUT_OF_RANGE (low above high). [one] */
CRUMBLE_API crumble_result crumble_sim_fix_box(crumble_sim sim, const double *low, const double *high);
/* Fixes more nodes: those at rest with normal . x <= offset. `normal`: (3), unit.
 * CRUMBLE_E_NULL, _INVALID_VALUE, _OUT_OF_RANGE (not a unit normal). [one] */
CRUMBLE_API crumble_result crumble_sim_fix_plane(crumble_sim sim, const double *normal, double offset);
/* The choices of the paper where it makes one: along-motion contact by nodes alone, fragments that do not touch, drag
 * against the room, equal masses, tau = 2.9 ms unchecked, one iteration, cuts after the move and without fading, the
 * mean force of Eq (7), friction 3.0 / 1.5 on every tool and wall there is, no gravity. Material and fixed nodes stay.
 * [one] */
CRUMBLE_API crumble_result crumble_sim_apply_paper_preset(crumble_sim sim);

/* One tick of the servo loop for a simulation with exactly one tool and no attachment: the tool goes to `pose`, the
 * body answers, time advances by tau, `wrench` receives what the body does to the tool. Never allocates (except while
 * recording), locks, waits or calls the system; but with `threads` above 1 it wakes sleeping threads and waits for
 * those at work, and it calls host_threads, which must not throw and must not call into the same simulation
 * (CRUMBLE_E_BUSY).
 * On every error *wrench is zero, so that a loop that ignores results pushes nobody. CRUMBLE_E_BAD_POSE (the body and
 * its time stand still in this call; counted in crumble_counters), _DIVERGED (the body left the world: it is frozen at
 * its last good state, and every further step says so until crumble_sim_reset), _OUT_OF_RANGE (another number of tools
 * and attachments), _NO_MEMORY (while recording: the step is done, the recording is dropped). [one] */
CRUMBLE_API crumble_result crumble_sim_step(crumble_sim sim, const crumble_pose *pose, crumble_wrench *wrench);
/* The same with `tool_count` poses and wrenches, one of each per tool and then one of each per attachment. Without any
 * both may be NULL with count 0. [one] */
CRUMBLE_API crumble_result crumble_sim_step_tools(crumble_sim sim, const crumble_pose *poses, crumble_wrench *wrenches,
                                                  uint32_t tool_count);
/* Several steps for a host whose frames are longer than one: a game's fixed update, a script. In `steps` (1 to 100000)
 * steps the tools go evenly from where they are to `poses`, where one that has not been placed is put at once;
 * `wrenches` receives the means, which times the time advanced are the impulses. Steps are whole or not at all: at least
 * one is done, and another only while it can be expected to end within `budget` seconds of wall time (0: all of them).
 * The tools stay where the last one brought them. `info` may be NULL. Poses, wrenches, memory and errors as
 * crumble_sim_step_tools; where a step fails, those before it stand, and all wrenches are zero. Also
 * CRUMBLE_E_OUT_OF_RANGE and _INVALID_VALUE (steps, budget), _UNINITIALIZED, _VERSION. [one] */
CRUMBLE_EXPERIMENTAL crumble_result crumble_sim_advance(crumble_sim sim, const crumble_pose *poses,
                                                        crumble_wrench *wrenches, uint32_t tool_count, uint32_t steps,
                                                        double budget, crumble_advance_info *info);
/* About the last step. CRUMBLE_E_UNINITIALIZED, _VERSION (struct_size). [one] */
CRUMBLE_API crumble_result crumble_sim_get_step_info(crumble_sim sim, crumble_step_info *info);
CRUMBLE_API crumble_result crumble_sim_get_counters(crumble_sim sim, crumble_counters *counters);
CRUMBLE_API crumble_result crumble_sim_get_profile(crumble_sim sim, crumble_profile *profile);
/* Sums since the start, with energy_audit in crumble_sim_def: CRUMBLE_E_STATE else. CRUMBLE_E_UNINITIALIZED, _VERSION
 * (struct_size). [one] */
CRUMBLE_API crumble_result crumble_sim_get_energy(crumble_sim sim, crumble_energy *energy);
/* How steps are computed. CRUMBLE_E_UNINITIALIZED, _VERSION (struct_size). [one] */
CRUMBLE_API crumble_result crumble_sim_get_info(crumble_sim sim, crumble_sim_info *info);

/* The nodes that tools, attachments and walls hold, in the order of holders, walls last. `count` receives how many there
 * are; `contacts` has room for `capacity` of them and may be NULL to ask for the count only.
 * CRUMBLE_E_BUFFER_TOO_SMALL (`count` is written, `contacts` is not). [one] */
CRUMBLE_API crumble_result crumble_sim_get_contacts(crumble_sim sim, crumble_contact *contacts, uint32_t capacity,
                                                    uint32_t *count);
/* The model of tool `tool`, or of attachment `tool` - number of tools, after a step. Takes some microseconds, no memory.
 * Without force after a step that failed. CRUMBLE_E_OUT_OF_RANGE (no such tool). [one] */
CRUMBLE_API crumble_result crumble_sim_get_local_model(crumble_sim sim, uint32_t tool, crumble_local_model *model);
/* What the body does to the tool at `pose`: contacts are followed one by one, each holds no more than its friction and
 * lets go when it would pull. Continuous in `pose`. No memory. On every error *wrench is zero.
 * CRUMBLE_E_BAD_POSE, _OUT_OF_RANGE (`listed`). [any] */
CRUMBLE_API crumble_result crumble_local_model_evaluate(const crumble_local_model *model, const crumble_pose *pose,
                                                        crumble_wrench *wrench);
/* Drag of the nodes that a tool or attachment holds, N s/m: what moving them through the room would take on top of the
 * force; never part of it. CRUMBLE_E_OUT_OF_RANGE (no such tool). [one] */
CRUMBLE_API crumble_result crumble_sim_get_held_drag(crumble_sim sim, uint32_t tool, double *drag);

/* Forces on nodes beside their weight, `forces`: (count, 3), N, of all nodes; or NULL with count 0: none any more. Kept
 * until changed or reset; part of the state; goes into a running recording. Between steps; takes time in proportion to
 * the body. CRUMBLE_E_INVALID_VALUE (the text names the node), _OUT_OF_RANGE (count; above 1e12 N along an axis),
 * _NO_MEMORY (nothing is changed; while recording it may be that all is done and the recording is dropped, as the text
 * says). [one] */
CRUMBLE_API crumble_result crumble_sim_set_node_forces(crumble_sim sim, const double *forces, uint32_t count);
/* The same for one node, `force`: 3 numbers. No memory except while recording. CRUMBLE_E_INVALID_VALUE, _OUT_OF_RANGE
 * (no such node; the force), _NO_MEMORY (while recording: it is done, the recording is dropped). [one] */
CRUMBLE_API crumble_result crumble_sim_set_node_force(crumble_sim sim, uint32_t node, const double *force);

/* Back to rest, unbroken, at time 0, with tools unplaced and counters at 0; also after CRUMBLE_E_DIVERGED.
 * CRUMBLE_E_STATE (recording). [one] */
CRUMBLE_API crumble_result crumble_sim_reset(crumble_sim sim);

/* Array `which` of the simulation groups of CRUMBLE_ARRAY_, without a copy. Ask again after every call that changes the
 * simulation: until then the view is valid. CRUMBLE_E_OUT_OF_RANGE (no such array), _UNSUPPORTED (exists as a copy
 * only), _STATE (no surface yet). [one] */
CRUMBLE_API crumble_result crumble_sim_get_view(crumble_sim sim, uint32_t which, crumble_view *view);
/* The same array, rows packed, into `dst` of `dst_bytes`. `needed` receives the bytes it takes and may be NULL; with
 * `dst` NULL the call only asks for it. CRUMBLE_E_OUT_OF_RANGE, _STATE, _BUFFER_TOO_SMALL (`needed` is written, `dst`
 * is not). [one] */
CRUMBLE_API crumble_result crumble_sim_copy(crumble_sim sim, uint32_t which, void *dst, uint64_t dst_bytes,
                                            uint64_t *needed);
/* Fragments: parts of the body that intact springs hold together; 1 for an unbroken body. Their ids run from 0 to
 * `count` - 1 and stay: when a fragment falls apart, the part with most nodes keeps the id and the others get new ones.
 * Removed fragments count too. In bodies of more than 4096 nodes a new id may come some steps after the cut. [one] */
CRUMBLE_API crumble_result crumble_sim_count_fragments(crumble_sim sim, uint32_t *count);
/* Puts a fragment to sleep, wakes it or removes it, CRUMBLE_FRAGMENT_; goes into a running recording. Between steps;
 * takes time in proportion to the body's nodes and no memory (except while recording).
 * CRUMBLE_E_OUT_OF_RANGE (no such fragment or state), _STATE (removed before), _NO_MEMORY (while recording: it is done,
 * the recording is dropped). [one] */
CRUMBLE_API crumble_result crumble_sim_set_fragment_state(crumble_sim sim, uint32_t fragment, uint32_t state);
CRUMBLE_API crumble_result crumble_sim_get_fragment_state(crumble_sim sim, uint32_t fragment, uint32_t *state);
/* Debris: the fragments, not removed, with at most `max_nodes` nodes that are all slower than `max_speed` (m/s) and not
 * held by a tool, as a view of uint32 ids, ascending; valid until the next call of this function, restore or set-up, so
 * their states may be set while it is read. No memory.
 * CRUMBLE_E_INVALID_VALUE (max_speed is NaN). [one] */
CRUMBLE_API crumble_result crumble_sim_find_debris(crumble_sim sim, uint32_t max_nodes, double max_speed,
                                                   crumble_view *fragments);
/* Brings the simulation's own surface arrays up to where the body is now: for programs with one thread; others use a
 * reader. Outside the servo tick. Closed, oriented and 2-manifold in every state of cutting. `info` may be NULL. The
 * first call takes memory, the others do not. CRUMBLE_E_UNINITIALIZED, _VERSION (struct_size), _NO_MEMORY. [one] */
CRUMBLE_API crumble_result crumble_sim_extract_surface(crumble_sim sim, crumble_surface_info *info);

/* Makes the present state available to every reader at once, asked or not: for programs with one thread, which call it
 * before crumble_reader_update. Takes time in proportion to the body, no memory. [one] */
CRUMBLE_API crumble_result crumble_sim_publish(crumble_sim sim);

/* All that the future depends on, as bytes: a simulation of the same definition (kernel and threads may be others) that
 * restores them goes on with the same bits. The size changes from step to step. `dst`, `dst_bytes`, `needed` as in
 * crumble_sim_copy. CRUMBLE_E_BUFFER_TOO_SMALL, _NO_MEMORY. [one] */
CRUMBLE_API crumble_result crumble_sim_snapshot(crumble_sim sim, void *dst, uint64_t dst_bytes, uint64_t *needed);
/* CRUMBLE_E_CORRUPT, _VERSION (of another definition or version of the library), _STATE (recording), _NO_MEMORY.
 * [one] */
CRUMBLE_API crumble_result crumble_sim_restore(crumble_sim sim, const void *snapshot, uint64_t bytes);
/* Hash of the state: equal bits, equal hash, on every machine, with every kernel and any number of threads. [one] */
CRUMBLE_API crumble_result crumble_sim_state_hash(crumble_sim sim, uint64_t *hash);

/* From here on every step's poses and state hash are kept. CRUMBLE_E_STATE (already recording), _NO_MEMORY. [one] */
CRUMBLE_API crumble_result crumble_sim_begin_recording(crumble_sim sim);
/* Writes what has been recorded so far; recording goes on. `path` is UTF-8; the file is replaced only when all of it is
 * written. CRUMBLE_E_STATE (not recording), _IO, _NO_MEMORY. [one] */
CRUMBLE_API crumble_result crumble_sim_save_recording(crumble_sim sim, const char *path);
/* Ends and forgets the recording. CRUMBLE_E_STATE (not recording). [one] */
CRUMBLE_API crumble_result crumble_sim_end_recording(crumble_sim sim);
/* Runs a recording again. `step_count` receives its steps and `equal_steps` how many of them, from the first on,
 * reached the recorded state: the same number when all is well. CRUMBLE_E_IO, _FORMAT, _VERSION, _CORRUPT, _NO_MEMORY.
 * [any] */
CRUMBLE_API crumble_result crumble_verify_recording(const char *path, uint64_t *step_count, uint64_t *equal_steps);

/* A recording's file, opened to be looked at step by step. */
typedef struct crumble_recording_t *crumble_recording;

typedef struct crumble_recording_info {
  uint32_t struct_size;
  uint32_t tool_count; /* and attachments: poses of each step */
  uint64_t step_count;
  uint64_t first_step; /* steps that the simulation had done before it was recorded */
} crumble_recording_info;

/* CRUMBLE_E_NULL, _IO, _FORMAT, _VERSION, _CORRUPT, _NO_MEMORY. [any] */
CRUMBLE_API crumble_result crumble_recording_load(const char *path, crumble_recording *recording);
/* NULL is allowed and does nothing. [one] */
CRUMBLE_API crumble_result crumble_recording_destroy(crumble_recording recording);
/* CRUMBLE_E_UNINITIALIZED, _VERSION (struct_size). [one] */
CRUMBLE_API crumble_result crumble_recording_get_info(crumble_recording recording, crumble_recording_info *info);
/* The simulation as it was where the recording begins. CRUMBLE_E_CORRUPT, _VERSION, _UNSUPPORTED (a tool of a support
 * function), _NO_MEMORY. [one] */
CRUMBLE_API crumble_result crumble_recording_create_sim(crumble_recording recording, crumble_sim *sim);
/* Does step `step` of the recording, from 0, with all that the host did to the simulation before it, and moves `sim`
 * from where step - 1 left it. `equal` receives 1 if it is then in the recorded state, else 0, and may be NULL. What the
 * tools felt tells crumble_sim_get_contacts. CRUMBLE_E_OUT_OF_RANGE (no such step; another number of tools), _CORRUPT,
 * _STATE (the simulation is being recorded), _DIVERGED, _NO_MEMORY. [one] in both */
CRUMBLE_API crumble_result crumble_recording_step(crumble_recording recording, crumble_sim sim, uint64_t step,
                                                  uint32_t *equal);

/* ---- Readers ---------------------------------------------------------------------------------------------------- */

/* Looks at a simulation from another thread, which draws, listens or logs at its own pace, say 60 times a second, while
 * the simulation is stepped at 1 kHz or more. Neither thread ever waits for the other: stepping hands over a copy of
 * its state when the reader has asked for one, at most 60 times in a second of simulated time. A body of more than 1024
 * nodes is copied in slices over up to 16 steps (more from 131 072 nodes on); such a state is a few steps older at one
 * end than at the other.
 * A reader outlives its simulation, with the last state; while a simulation has readers it gets no more tools and
 * attachments. */
typedef struct crumble_reader_t *crumble_reader;

/* What a cut spring opens in the surface. */
enum {
  CRUMBLE_SURFACE_CRACKS = 0,    /* notches and cracks, at once; closed and 2-manifold */
  CRUMBLE_SURFACE_FRAGMENTS = 1, /* nothing before a fragment is free; closed and 2-manifold */
  CRUMBLE_SURFACE_PAPER = 2      /* the paper's drawing, Fig 6; closed, but parts of it touch in edges and corners */
};

typedef struct crumble_reader_def {
  uint32_t struct_size;
  uint32_t surface_mode; /* CRUMBLE_SURFACE_; default cracks */
  double settle;         /* s that what a cut has freed takes to its new place; >= 0; default 0.05 */
  double crease;         /* skin edges sharper than this at rest are shaded sharp, rad; [0, pi]; default 40 degrees */
} crumble_reader_def;

typedef struct crumble_reader_info {
  uint32_t struct_size;
  uint32_t fragment_count; /* ids given so far; removed fragments count too */
  uint64_t step;           /* steps done when the copy of the state was complete */
  double time;             /* simulated seconds then */
  uint64_t first_step;     /* steps done when it was begun: the same but for large bodies */
  uint64_t cuts;           /* springs cut */
  uint64_t dropped_events; /* that this reader did not read in time */
  uint32_t vertex_count;   /* of the surface */
  uint32_t triangle_count;
  uint32_t skin_triangle_count; /* the first triangles; the others were laid open by cracks */
  uint32_t surface_rebuilt;     /* 1: everything in it may have changed */
} crumble_reader_info;

typedef struct crumble_fragment_info {
  uint32_t struct_size;
  uint32_t node_count;        /* 0: removed */
  uint32_t tetrahedron_count; /* that lie in it with all four corners */
  uint32_t least_node;        /* CRUMBLE_NONE when removed */
  uint32_t parent;            /* fragment that it came off; CRUMBLE_NONE: there from the start */
  uint32_t state;             /* CRUMBLE_FRAGMENT_ */
  uint64_t born;              /* step in which it was found */
  double mass;                /* kg */
  double rest_volume;         /* m^3; over all fragments the body's */
  double center[3];           /* of mass, m */
  double low[3], high[3];     /* corners of the box round its nodes, m */
  double inertia[6];          /* of its nodes as points about the center, scene axes: xx yy zz xy xz yz, kg m^2 */
} crumble_fragment_info;

/* Lists of one fragment, uint32, ascending. */
enum {
  CRUMBLE_LIST_NODES = 0,
  CRUMBLE_LIST_TETRAHEDRA = 1, /* with all four corners in it */
  CRUMBLE_LIST_TRIANGLES = 2 /* of the surface; they alone are closed too, but in mode `fragments` on large bodies while
                                ids lag, and where parts touch in mode `paper` */
};

enum {
  CRUMBLE_EVENT_CUT = 1,
  CRUMBLE_EVENT_SPLIT = 2,         /* a fragment came off another */
  CRUMBLE_EVENT_CONTACT_BEGIN = 3, /* a tool or wall took hold of a node */
  CRUMBLE_EVENT_CONTACT_END = 4    /* and let it go */
};

/* What does not apply is CRUMBLE_NONE. This struct never changes its size. */
typedef struct crumble_event {
  uint32_t kind;     /* CRUMBLE_EVENT_ */
  uint32_t spring;   /* cut */
  uint32_t node;     /* contact; split: a node of the new fragment */
  uint32_t holder;   /* contact: the tool; CRUMBLE_NONE: a wall */
  uint32_t fragment; /* of the spring's first node or of the node; split: the new one */
  uint32_t parent;   /* split: what it came off */
  uint64_t step;     /* in which it happened, from 0 */
  double time;       /* simulated seconds at that step's end */
  double place[3];   /* m: the spring's middle, the node of a split, the point of a contact that begins, the node of one
                        that ends */
  double energy;     /* J. Cut: k/2 (l - l0)^2 of the spring; contact begin: m/2 v^2 of the node's approach along the
                        normal; else 0 */
} crumble_event;

/* Defaults. CRUMBLE_E_NULL, _UNINITIALIZED (size 0), _VERSION (a size that no version has). [any] */
CRUMBLE_API crumble_result crumble_reader_def_init(crumble_reader_def *def, uint32_t struct_size);
/* `def` may be NULL: defaults. Holds the state that the simulation is in.
 * CRUMBLE_E_INVALID_VALUE, _OUT_OF_RANGE (a field), _UNINITIALIZED, _VERSION, _NO_MEMORY. [one] in the simulation */
CRUMBLE_API crumble_result crumble_reader_create(crumble_sim sim, const crumble_reader_def *def,
                                                 crumble_reader *reader);
/* NULL is allowed and does nothing. [one] */
CRUMBLE_API crumble_result crumble_reader_destroy(crumble_reader reader);
/* Takes the newest state, brings the arrays and the surface up to it, and asks for the next. Never waits for the
 * stepping thread; no memory. `info` may be NULL. CRUMBLE_E_UNINITIALIZED, _VERSION (struct_size). [one] */
CRUMBLE_API crumble_result crumble_reader_update(crumble_reader reader, crumble_reader_info *info);
/* Array `which`, without a copy, valid until the next crumble_reader_update or destroy. CRUMBLE_E_OUT_OF_RANGE (no such
 * array of a reader), _UNSUPPORTED (exists as a copy only). [one] */
CRUMBLE_API crumble_result crumble_reader_get_view(crumble_reader reader, uint32_t which, crumble_view *view);
/* The same array, rows packed; `dst`, `dst_bytes`, `needed` as in crumble_sim_copy.
 * CRUMBLE_E_OUT_OF_RANGE, _BUFFER_TOO_SMALL. [one] */
CRUMBLE_API crumble_result crumble_reader_copy(crumble_reader reader, uint32_t which, void *dst, uint64_t dst_bytes,
                                               uint64_t *needed);
/* One fragment as of the last update. The first call after an update measures all of them.
 * CRUMBLE_E_OUT_OF_RANGE (no such fragment), _UNINITIALIZED, _VERSION (struct_size). [one] */
CRUMBLE_API crumble_result crumble_reader_get_fragment(crumble_reader reader, uint32_t fragment,
                                                       crumble_fragment_info *info);
/* Its CRUMBLE_LIST_, without a copy, valid until the next update or destroy. CRUMBLE_E_OUT_OF_RANGE. [one] */
CRUMBLE_API crumble_result crumble_reader_get_fragment_list(crumble_reader reader, uint32_t fragment, uint32_t which,
                                                            crumble_view *list);
/* Spreads texture coordinates over the skin: `boundary`: (boundary triangles, 6) float32, u and v at each corner of the
 * triangles of CRUMBLE_ARRAY_BOUNDARY; `skin`: (skin triangles, 6), written, interpolated as in the body at rest.
 * `skin_count`: triangles that it has room for. CRUMBLE_E_BUFFER_TOO_SMALL. [one] */
CRUMBLE_API crumble_result crumble_reader_spread_over_skin(crumble_reader reader, const float *boundary, float *skin,
                                                           uint32_t skin_count);
/* Takes the oldest events that this reader has not read: up to `capacity`, into `events`; `count` receives how many.
 * 16384 can wait; what comes on top is dropped and counted. No update needed. [one] */
CRUMBLE_API crumble_result crumble_reader_read_events(crumble_reader reader, crumble_event *events, uint32_t capacity,
                                                      uint32_t *count);

/* ---- Devices ---------------------------------------------------------------------------------------------------- */

/* A haptic device, or what stands in for one: a sample comes out of it, a force goes into it. It is open from its
 * construction on. Positions, velocities and forces are in the device's own right-handed frame: x right, y up, z
 * towards the user; the workspace of crumble_hand_def maps that frame to the scene.
 * A loop that runs has its devices to itself (CRUMBLE_E_BUSY); while a loop exists its devices cannot be destroyed. */
typedef struct crumble_device_t *crumble_device;

enum {
  CRUMBLE_DEVICE_NULL = 0,    /* a pose that never moves */
  CRUMBLE_DEVICE_PRESS = 1,   /* a scripted straight press */
  CRUMBLE_DEVICE_REPLAY = 2,  /* a trajectory from a file */
  CRUMBLE_DEVICE_PHANTOM = 3, /* 3D Systems PHANToM / Touch through HDAPI, which is loaded when one is opened */
  CRUMBLE_DEVICE_CUSTOM = 4,  /* the host's own, by callbacks */
  CRUMBLE_DEVICE_PATH = 5,    /* scripted moves and turns */
  CRUMBLE_DEVICE_HAND = 6,    /* a simulated hand that holds a simulated device: the one that feels the force */
  CRUMBLE_DEVICE_POKE = 7,    /* scripted pokes of least jerk, as a finger does them */
  CRUMBLE_DEVICE_TREMOR = 8,  /* a hand that only trembles */
  CRUMBLE_DEVICE_WANDER = 9,  /* a hand that goes from one random place to the next */
  CRUMBLE_DEVICE_INVERSE3 = 10 /* Haply Inverse3 through the WebSocket of its local service */
};

/* What a device senses. */
enum {
  CRUMBLE_SENSES_POSITION = 1,
  CRUMBLE_SENSES_ORIENTATION = 2,
  CRUMBLE_SENSES_LINEAR_VELOCITY = 4,
  CRUMBLE_SENSES_ANGULAR_VELOCITY = 8,
  CRUMBLE_SENSES_BUTTONS = 16
};

/* How a device runs. */
enum {
  CRUMBLE_DEVICE_STEP_LOCKED = 1, /* read k is tick k, whatever the wall clock says */
  CRUMBLE_DEVICE_SERVO_DRIVEN = 2 /* has a thread of its own that calls the tick: see CRUMBLE_DRIVER_ */
};

/* What came of a read. */
enum {
  CRUMBLE_READ_OK = 0,
  CRUMBLE_READ_NO_NEW_SAMPLE = 1, /* the rest of the sample means nothing */
  CRUMBLE_READ_FINISHED = 2       /* the motion is over; the last pose, held at rest */
};

/* Of a sample. */
enum {
  CRUMBLE_SAMPLE_RESAMPLED = 1,    /* interpolated between recorded rows, not recorded at this time */
  CRUMBLE_SAMPLE_FINISHED = 2,     /* with CRUMBLE_READ_FINISHED */
  CRUMBLE_SAMPLE_UNCALIBRATED = 4, /* the pose means nothing yet: a loop waits and gives no force */
  CRUMBLE_SAMPLE_HELD = 8,         /* not given by devices */
  CRUMBLE_SAMPLE_FORCE_OFF = 16    /* the device's driver took the force away: see crumble_device_get_text */
};

/* Everything that belongs to one instant, device frame. */
typedef struct crumble_device_sample {
  uint32_t struct_size;
  uint32_t status;   /* CRUMBLE_READ_ */
  uint32_t buttons;  /* bit set: pressed */
  uint32_t flags;    /* CRUMBLE_SAMPLE_ bits */
  uint64_t sequence; /* counts from 0; a gap means samples that nobody read */
  double time;       /* s since the device was opened, by its own clock */
  crumble_pose pose;
  double linear_velocity[3];  /* m/s */
  double angular_velocity[3]; /* rad/s */
  double motor_temperature;   /* of the hottest motor, 0 cold to 1 its limit; 0 where it is not sensed */
} crumble_device_sample;

/* A limit of 0 is one that the device does not tell. */
typedef struct crumble_device_info {
  uint32_t struct_size;
  uint32_t kind;            /* CRUMBLE_DEVICE_ */
  uint32_t measured;        /* CRUMBLE_SENSES_ bits; the rest of a sample is derived or zero */
  uint32_t flags;           /* CRUMBLE_DEVICE_STEP_LOCKED, _SERVO_DRIVEN */
  char name[64];            /* for people, UTF-8, ends with a zero */
  double rate;              /* nominal samples per second */
  double max_force;         /* N, peak */
  double continuous_force;  /* N, that the motors bear for long */
  double max_torque;        /* N m; 0 also when it has no motors for it */
  double max_stiffness;     /* N/m that its maker holds for stable at 1 kHz */
  double max_damping;       /* N s/m, likewise */
  double max_speed;         /* m/s, beyond which its driver stops */
  double mass;              /* kg, apparent at the tip */
  double friction_damping;  /* N s/m of its own, at least */
  double position_step;     /* m, of its encoders at the tip */
  double workspace_low[3];  /* m, device frame: corners of where it can be used; ... */
  double workspace_high[3]; /* ... equal ones: everywhere */
  int32_t callback_error;   /* custom: what a callback answered when the device was lost; else 0 */
  uint32_t reserved;        /* 0 */
  char driver[160];         /* for people, UTF-8: what stands between, its version, where it was found */
  char serial[64];          /* the maker's number of the device; empty: it tells none */
} crumble_device_info;

/* Calls the loop for one tick; read and write are called from within. 0: do not call again. */
typedef uint32_t (*crumble_device_tick)(void *tick_context);

/* A device of the host's own. Each callback gets `user` last and returns a crumble_result: any value but CRUMBLE_OK
 * means that the device is lost from then on; `write` is still called then, with zeros. They are called from one thread
 * at a time: from that which calls crumble_device_read and _write, crumble_loop_tick, or from that of the loop; `read`
 * and `write` must not take memory or block when a loop is to keep its time. They may call what is [any]. They do not
 * bypass the safety stages: a loop believes no sample and sends no force without them. Zero is written by
 * crumble_loop_stop, and by the watchdog's thread when ticks stay out. */
typedef struct crumble_device_callbacks {
  uint32_t struct_size;
  uint32_t measured; /* CRUMBLE_SENSES_ bits; default position alone */
  uint32_t flags;    /* CRUMBLE_DEVICE_STEP_LOCKED, _SERVO_DRIVEN; default 0 */
  uint32_t reserved; /* keep 0 */
  void *user;        /* given to the callbacks; must outlive the device */
  /* Fills `sample`, which comes with status CRUMBLE_READ_OK, a unit orientation, its number and zeros. Required. */
  crumble_result (*read)(crumble_device_sample *sample, void *user);
  /* Force (3), N, and torque (3), N m, on the hand, device frame, until the next write. Required. */
  crumble_result (*write)(const double *force, const double *torque, void *user);
  /* With CRUMBLE_DEVICE_SERVO_DRIVEN, required then: call tick(tick_context) from now on in a thread of the host's
   * every period, until it answers 0 or `stop` is called, which returns when the last call has. */
  crumble_result (*start)(crumble_device_tick tick, void *tick_context, void *user);
  crumble_result (*stop)(void *user);
  const char *name; /* UTF-8; copied; NULL (default): "custom device" */
  double rate;      /* this and the following as in crumble_device_info; finite and not negative; default 0 */
  double max_force;
  double continuous_force;
  double max_torque;
  double max_stiffness;
  double max_damping;
  double max_speed;
  double mass;
  double friction_damping;
  double position_step;
  double workspace_low[3];
  double workspace_high[3]; /* not below workspace_low */
} crumble_device_callbacks;

/* Where a scripted motion comes by. This struct never changes its size. */
typedef struct crumble_motion_point {
  double time;    /* s, from 0 on, increasing from point to point */
  double move[3]; /* m, from where it started */
  double turn[3]; /* path: unit axis times radians, from how it stood when it started, about its own origin */
} crumble_motion_point;

/* What time a replay goes by. */
enum {
  CRUMBLE_CLOCK_STEP_LOCKED = 0, /* read k gives the motion k ticks after replay_from */
  CRUMBLE_CLOCK_REALTIME = 1,    /* a read gives the motion as long after replay_from as the first read is ago */
  CRUMBLE_CLOCK_FAST = 2         /* a read gives the next row of the file, as it was recorded */
};

/* One struct for all kinds, so that a program changes nothing but `kind`; what another kind needs is not looked at. */
typedef struct crumble_device_def {
  uint32_t struct_size;
  uint32_t kind;             /* CRUMBLE_DEVICE_; default null */
  double tick;               /* simulated kinds, replay: s from read to read; > 0; default 0.001 */
  crumble_pose start;        /* null, press, path, hand, poke, tremor, wander: device frame; default the origin */
  double press_direction[3]; /* press, poke: any length but 0; default 0, -1, 0 */
  double press_speed;        /* m/s; > 0; default 0.001 */
  double press_depth;        /* m; > 0; default 0.03 */
  double press_hold;         /* s that it then stays; >= 0; default 0 */
  const char *trajectory;    /* replay: path of a .ctraj file, UTF-8; default NULL */
  double replay_from;        /* s, in the trajectory's own time; default -infinity: its first row ... */
  double replay_to;          /* ... to here; default +infinity: its last row */
  uint32_t replay_loop;      /* 1: starts again at the end; 0 (default): the last pose stays */
  uint32_t point_count;      /* path, hand: of `points`, one at least */
  const crumble_motion_point *points; /* copied. A path goes straight from each to the next at constant speed; where a
                                         hand wants to be goes with least jerk, at rest in each */
  double hand_mass;          /* of hand and device, kg; > 0; default 0.1 */
  double hand_stiffness;     /* of the grip, N/m; >= 0; default 50 */
  double hand_damping;       /* of both, N s/m; >= 0; default 0.5 */
  double hand_friction;      /* dry, in the device, N; >= 0; default 0 */
  double hand_encoder_step;  /* m: positions are told in whole steps of it; 0 (default): as they are */
  double hand_device_mass;   /* of the device alone, kg, as its info tells; (0, hand_mass]; default 0.075 */
  double hand_max_force;     /* N, of its motors, which give no more; > 0; default 3.3 */
  double hand_max_stiffness; /* N/m, as its info tells; 0 (default): it does not */
  double hand_max_damping;   /* N s/m, likewise; default 0 */
  uint32_t hand_delay;       /* ticks between a write and its force; [0, 64]; default 0 */
  uint32_t reserved;         /* keep 0 */
  const crumble_device_callbacks *callbacks; /* custom: the table, copied; default NULL */
  uint32_t replay_clock;     /* CRUMBLE_CLOCK_; default step-locked */
  uint32_t record_capacity;  /* any kind: samples that are kept, with the force written after each, for
                                crumble_device_save_trajectory; at most 10000000; 0 (default): none */
  const char *phantom_library; /* path of HDAPI; NULL (default): that in the environment variable CRUMBLE_HDAPI, else
                                  where its installer puts it. A process has one */
  const char *phantom_name;  /* as in the driver's configuration; NULL (default): the first device */
  double phantom_rate;       /* Hz, [500, 8000]; default 1000. A driver that does not take it keeps its own */
  double phantom_tip[3];     /* m, stylus frame, from where its axes meet, whose position the driver tells; default 0 */
  uint32_t phantom_torque;   /* experimental. 1: torques too, where the device has six motors; default 0 */
  uint32_t phantom_reset_encoders; /* 1: the arm is being held in its reset position: take it for that; default 0 */
  uint32_t phantom_keep_enabled;   /* 1: not disabled when closed, by which some FireWire models crash; default 0 */
  uint32_t poke_count;       /* >= 1; default 1 */
  const char *phantom_license_vendor; /* these three for commercial programs, which the maker asks; NULL (default) */
  const char *phantom_license_application;
  const char *phantom_license_password;
  double poke_depth;         /* m along press_direction; > 0; default 0.01 */
  double poke_in;            /* s to go in; > 0; default 0.5 */
  double poke_hold;          /* s still there; >= 0; default 0.5 */
  double poke_out;           /* s to come back; > 0; default 0.5 */
  double poke_rest;          /* s still between two; >= 0; default 0.5 */
  uint64_t seed;             /* tremor, wander; default 0 */
  double seconds;            /* tremor, wander: >= 0; 0 (default): without end */
  double tremor_amplitude;   /* m, root mean square; > 0; default 0.0001 */
  double tremor_low;         /* Hz; > 0; default 8 */
  double tremor_high;        /* Hz; > tremor_low, at most half of 1 / tick; default 12 */
  double wander_low[3];      /* m, from start: corners of the box, <= 0; default -0.02 each ... */
  double wander_high[3];     /* ... and >= 0; default 0.02 each */
  double wander_slowest;     /* m/s, mean speed of one move; > 0; default 0.02 */
  double wander_fastest;     /* m/s; >= wander_slowest; default 0.1 */
  double wander_max_pause;   /* s; >= 0; default 0.5 */
  double wander_max_turn;    /* rad, [0, pi]; default 0 */
  const char *inverse3_host; /* NULL (default): localhost */
  const char *inverse3_device_id; /* as the service tells it; NULL (default): the first */
  double inverse3_timeout;   /* s, to connect and to hear of a first state; > 0; default 2 */
  uint32_t inverse3_port;    /* [1, 65535]; default 10001 */
  uint32_t reserved2;        /* keep 0 */
} crumble_device_def;

/* What there is of hardware. This struct never changes its size. */
typedef struct crumble_attached_device {
  uint32_t kind;          /* CRUMBLE_DEVICE_ */
  uint32_t can_be_opened; /* 1: nothing that is needed is missing; opening it is worth trying */
  char name[112];         /* for people, UTF-8: what was found, and where */
  char note[512];         /* what is missing, or how it is opened */
} crumble_attached_device;

/* Defaults. CRUMBLE_E_NULL, _UNINITIALIZED (size 0), _VERSION (a size that no version has). [any] */
CRUMBLE_API crumble_result crumble_device_def_init(crumble_device_def *def, uint32_t struct_size);
CRUMBLE_API crumble_result crumble_device_callbacks_init(crumble_device_callbacks *callbacks, uint32_t struct_size);
/* The kinds that this build opens, as "hand" and so on: number `index`, from 0, and NULL when there are no more. Static
 * text. [any] */
CRUMBLE_API const char *crumble_device_kind_name(uint32_t index);
/* The number of the kind called `name`, for crumble_device_def: so a user chooses by a word. Kinds that this build
 * cannot open have a number too. CRUMBLE_E_UNSUPPORTED (no such kind; the text lists them). [any] */
CRUMBLE_API crumble_result crumble_device_kind(const char *name, uint32_t *kind);
/* Opens a device of any kind. CRUMBLE_E_INVALID_VALUE, _OUT_OF_RANGE and _BAD_POSE (the text names the field),
 * _UNINITIALIZED, _VERSION, _UNSUPPORTED (a kind that this build does not have; the text lists those it has), _EMPTY
 * (no points), _NULL (trajectory, points, callbacks, or one of these that is required), _NO_MEMORY; replay also _IO,
 * _FORMAT, _CORRUPT, _TOO_LARGE, as the file is. [any] */
CRUMBLE_API crumble_result crumble_device_open(const crumble_device_def *def, crumble_device *device);
/* NULL is allowed and does nothing. CRUMBLE_E_IN_USE (a loop has it). [one] */
CRUMBLE_API crumble_result crumble_device_destroy(crumble_device device);
/* CRUMBLE_E_UNINITIALIZED, _VERSION (struct_size). [one] */
CRUMBLE_API crumble_result crumble_device_get_info(crumble_device device, crumble_device_info *info);
/* What is wrong with the device, for people: why it is lost or took the force away, how to calibrate it; "" when
 * nothing is or it does not tell. The text lives until the device is destroyed. CRUMBLE_E_NULL. [any] */
CRUMBLE_API crumble_result crumble_device_get_text(crumble_device device, const char **text);
/* What was recorded of it so far, as a .ctraj file. CRUMBLE_E_STATE (record_capacity was 0), _EMPTY (no sample yet),
 * _IO, _NO_MEMORY. [one] */
CRUMBLE_API crumble_result crumble_device_save_trajectory(crumble_device device, const char *path);
/* Makes a .ctraj file of a text log that HAPI's DeviceLog wrote. `length_unit`: m per unit of its lengths, > 0; rows
 * that repeat the time of the one before are left out. CRUMBLE_E_NULL, _INVALID_VALUE, _OUT_OF_RANGE, _IO, _EMPTY,
 * _FORMAT, _UNSUPPORTED (a binary log), _BAD_POSE, _CORRUPT, _TOO_LARGE (the text names line and column),
 * _NO_MEMORY. [any] */
CRUMBLE_API crumble_result crumble_trajectory_import_hapi(const char *log, double length_unit, const char *trajectory);
/* Hardware on USB that the kinds of this build are for, and drivers without it: opens no device, but loads HDAPI
 * (`library` as phantom_library). Writes at most `capacity` of them, and to `count` how many there are. CRUMBLE_E_NULL
 * (count; devices where capacity is not 0), _BUFFER_TOO_SMALL (all that fit have been written), _NO_MEMORY. [any] */
CRUMBLE_API crumble_result crumble_device_find_attached(const char *library, crumble_attached_device *devices,
                                                        uint32_t capacity, uint32_t *count);
/* The next sample, for programs that do without a loop. Where sample->status is CRUMBLE_READ_NO_NEW_SAMPLE the rest is
 * as it was. The first read or write of a servo-driven device starts its thread, which then exchanges with this one, and
 * makes zero of a force that nobody renews for 20 ms. CRUMBLE_E_DEVICE_LOST (for good: open it again), _UNINITIALIZED,
 * _VERSION (struct_size). [one] */
CRUMBLE_API crumble_result crumble_device_read(crumble_device device, crumble_device_sample *sample);
/* Force (3), N, and torque (3), N m, or NULL for none, on the hand, until the next write: past all safety stages, which
 * a loop has. CRUMBLE_E_INVALID_VALUE (not finite), _DEVICE_LOST. [one] */
CRUMBLE_API crumble_result crumble_device_write(crumble_device device, const double *force, const double *torque);

/* ---- Loops ------------------------------------------------------------------------------------------------------ */

/* The haptic loop: reads devices, moves tools, steps the body, and sends what is fit for a hand. Every sample is looked
 * at before it is believed, and no force reaches a device but through the safety stages; why a hand gets no force is
 * told as its fault, which stays until crumble_loop_reset_fault.
 * While a loop exists, its simulation and devices cannot be destroyed, nor the simulation get more tools
 * (CRUMBLE_E_IN_USE). From crumble_loop_start to crumble_loop_stop they are the loop's own, and so they are in
 * crumble_loop_tick: every call with them is answered CRUMBLE_E_BUSY. Readers go on; make them before the start. A
 * recording that runs goes on too, and makes ticks take memory. What is [any] here can be asked while the loop runs. */
typedef struct crumble_loop_t *crumble_loop;

/* How a tick gets its force from the body. */
enum {
  CRUMBLE_COUPLING_DIRECT = 0,      /* the body is stepped in the tick */
  CRUMBLE_COUPLING_LOCAL_MODEL = 1, /* it is stepped every body_ticks, and its local model answers in between */
  CRUMBLE_COUPLING_PAPER = 2        /* the same, with the mean of its last five forces, Eq (7), held in between */
};

/* Who ticks. A servo-driven device that does not drive is exchanged with, which makes its force a tick late. */
enum {
  CRUMBLE_DRIVER_OWN_THREAD = 0, /* crumble_loop_start makes a thread */
  CRUMBLE_DRIVER_DEVICE = 1,     /* it hands the tick to the first device that is servo-driven */
  CRUMBLE_DRIVER_HOST = 2,       /* whoever calls crumble_loop_tick */
  CRUMBLE_DRIVER_AUTOMATIC = 3   /* device if there is such a device, else own thread */
};

/* Hands of one loop, at most. */
#define CRUMBLE_MOST_HANDS 4

typedef struct crumble_loop_def {
  uint32_t struct_size;
  uint32_t coupling;    /* CRUMBLE_COUPLING_; default direct */
  double tick;          /* s, of the servo; [0.0001, 0.01]; default 0.001 */
  uint32_t body_ticks;  /* local model, paper: ticks to a step of the body, [1, 100]; default 1. The simulation's tau
                           (times its iterations) has to be tick * body_ticks */
  uint32_t body_thread; /* local model, paper: 1: the body has a thread of its own; 0 (default): every body_ticks-th
                           tick steps it */
  uint32_t driver;      /* CRUMBLE_DRIVER_; default automatic */
  uint32_t watchdog;    /* 1 (default): from start to stop a thread takes the force away when ticks stay out for 20 ms.
                           Where a device drives, none but its driver can: the hand is faulted, no more */
  int32_t priority;     /* of SCHED_FIFO for our thread, [1, 99]; 0: as the system likes; default 80. Where it is not
                           allowed the loop runs without: crumble_loop_get_scheduling */
  int32_t processor;    /* for our thread to stay on, [0, 1023]; -1 (default): any */
  uint32_t lock_memory; /* 1: mlockall, of the whole process; default 0 */
  uint32_t reserved;    /* keep 0 */
} crumble_loop_def;

/* One device that moves one tool. In arrays all have the same struct_size. */
typedef struct crumble_hand_def {
  uint32_t struct_size;
  uint32_t tool;             /* that it moves; behind the tools, attachment; default 0 */
  crumble_device device;     /* must outlive the loop */
  crumble_pose workspace;    /* the device's origin in the scene and how its axes are turned; default as the scene's */
  double workspace_mount[4]; /* w, x, y, z: how the tool is turned against the stylus that holds it; default none */
  double workspace_scale;    /* scene metres per device metre; > 0; default 1 */
  double force_gain;         /* 1 (default) gives the hand the power that the scene takes; >= 0 */
  uint32_t clutch_buttons;   /* while any of these is down the tool stays and the hand is free; 0 (default): none */
  uint32_t coupling;         /* 1 (default): a spring between hand and tool, all that can be felt; 0: none */
  double coupling_stiffness; /* of it, as felt, N/m; 0 (default): the most that is known to be quiet with this device */
  uint32_t inject_damping;   /* 1 (default): as much as sampling makes of the stiffness; 0: none */
  uint32_t controller;       /* 1: brakes when more energy has come out than energy_credit allows; default 0 */
  double delay;              /* ticks from a sample to its force in the motors, the hold not counted; [0, 64]; 1 */
  double max_damping;        /* that may be injected, N s/m; 0 (default): the device's, 5 where it tells none */
  double energy_credit;      /* J; > 0; default 0.02 */
  /* Safety. A device's own smaller limits come first. */
  double max_force;        /* N, as felt; > 0; default 3 */
  double max_torque;       /* N m, as felt; >= 0; default 0.1 */
  double max_speed;        /* m/s of the device; > 0; default 1. Above it the hand is let go */
  double max_jump;         /* m between two samples; > 0; default 0.005. A longer one is held back for a tick */
  double max_slew;         /* N/s: how fast the force may grow; > 0; default 300 */
  double ramp_time;        /* s in which it comes in after start, clutch and reset; >= 0; default 0.5 */
  double workspace_margin; /* m outside the device's workspace over which the force goes to 0; > 0; default 0.01 */
  uint32_t good_samples;   /* in a row before a hand touches anything; default 100 */
  uint32_t reserved;       /* keep 0 */
} crumble_hand_def;

/* Why a hand gets no force. */
enum {
  CRUMBLE_FAULT_NONE = 0,
  CRUMBLE_FAULT_NOT_FINITE = 1,  /* the device told, or the body answered, what is not a finite number */
  CRUMBLE_FAULT_BAD_POSE = 2,    /* the device told an orientation that is no rotation */
  CRUMBLE_FAULT_SPEED = 3,       /* the device moved faster than max_speed, or went on jumping */
  CRUMBLE_FAULT_STALLED = 4,     /* the body did not answer for 20 ms, or no tick came for so long */
  CRUMBLE_FAULT_SILENT = 5,      /* the device told nothing new for 20 ms */
  CRUMBLE_FAULT_DEVICE_LOST = 6, /* the device says that it is gone */
  CRUMBLE_FAULT_BODY = 7,        /* the body left the world: crumble_sim_reset */
  CRUMBLE_FAULT_HALTED = 8,      /* crumble_loop_halt */
  CRUMBLE_FAULT_DRIVER = 9       /* the device's own driver took the force away: crumble_device_get_text says why */
};

enum {
  CRUMBLE_HAND_WAITING = 0, /* no force and no contact: for good_samples, and until the tool is outside the body */
  CRUMBLE_HAND_RAMPING = 1, /* force comes in */
  CRUMBLE_HAND_RUNNING = 2,
  CRUMBLE_HAND_CLUTCHED = 3, /* a clutch button is down */
  CRUMBLE_HAND_FAULTED = 4   /* no force and no contact until crumble_loop_reset_fault */
};

/* A loop as its last tick left it. */
typedef struct crumble_loop_status {
  uint32_t struct_size;
  uint32_t running; /* 1: between start and stop */
  uint64_t ticks;
  uint64_t steps;         /* of the body */
  uint64_t missed;        /* deadlines: ticks that never were; simulated time lags by as many */
  uint64_t late_answers;  /* ticks with an answer older than a step of the body takes */
  uint64_t watchdog;      /* times that the watchdog took the force away */
  double time;            /* simulated s */
  uint32_t hand_count;
  uint32_t warning_count; /* for crumble_loop_get_warning */
} crumble_loop_status;

/* One hand as the last tick left it. */
typedef struct crumble_hand_status {
  uint32_t struct_size;
  uint32_t state;           /* CRUMBLE_HAND_ */
  uint32_t fault;           /* CRUMBLE_FAULT_ */
  uint32_t finished;        /* 1: the device's motion is over */
  uint32_t buttons;         /* of the last sample */
  uint32_t contacts;        /* nodes that the tool holds */
  int32_t callback_error;   /* as in crumble_device_info */
  uint32_t reserved;        /* 0 */
  double ramp;              /* share of the force that is let through, 0 to 1 */
  double time;              /* s, of the last sample, by the device's clock */
  crumble_pose device_pose; /* device frame */
  double velocity[3];       /* m/s, device frame: what damping and guards go by */
  crumble_pose tool_pose;   /* in the scene; where the body meets it */
  crumble_wrench body;      /* what the body did to the tool, scene */
  double force[3];          /* sent, N, device frame */
  double torque[3];         /* sent, N m, device frame */
  double stiffness;         /* N/m that the hand feels at most: the coupling's, or the contacts' */
  double damping;           /* injected now, N s/m */
  /* Energy between loop and hand, J. */
  double absorbed;         /* by the loop: the sum of - F . dx of the forces sent */
  double least_absorbed;   /* ever: negative when more has come out than went in */
  double injected;         /* of it, taken by injected damping */
  double controlled;       /* of it, taken by the controller */
  double credit;           /* that the controller goes by */
  double required_damping; /* N s/m: the most that was needed at any time, whatever was allowed */
  /* How often a safety stage had to do something. */
  uint64_t held;       /* samples: a jump, the pose before it stood for one tick */
  uint64_t aged;       /* ticks in which the body's answer was old */
  uint64_t outside;    /* ticks outside the device's workspace */
  uint64_t clamped;    /* ticks in which the force was more than allowed */
  uint64_t heated;     /* ticks in which warm motors took force away */
  uint64_t slewed;     /* ticks in which the force would have grown too fast */
  uint64_t capped;     /* ticks in which injected damping would have been more than the device bears */
  uint64_t faults;     /* latched */
  uint64_t unanswered; /* ticks for which the device had no new sample */
} crumble_hand_status;

/* Of times, s; all that there were, to within 3 %. This struct never changes its size. */
typedef struct crumble_percentiles {
  uint64_t count;
  double p50;
  double p99;
  double p99_9;
  double max;
} crumble_percentiles;

typedef struct crumble_loop_times {
  uint32_t struct_size;
  uint32_t reserved;             /* 0 */
  crumble_percentiles tick_wall; /* wall time of a tick */
  crumble_percentiles tick_cpu;  /* CPU time, where the loop has a thread of its own */
  crumble_percentiles lateness;  /* from the deadline to the tick's beginning, likewise */
  crumble_percentiles period;    /* from tick to tick */
  double rate;                   /* ticks a second, mean since the first */
} crumble_loop_times;

/* Defaults. CRUMBLE_E_NULL, _UNINITIALIZED (size 0), _VERSION (a size that no version has). [any] */
CRUMBLE_API crumble_result crumble_loop_def_init(crumble_loop_def *def, uint32_t struct_size);
CRUMBLE_API crumble_result crumble_hand_def_init(crumble_hand_def *def, uint32_t struct_size);
/* The choices of the paper: coupling CRUMBLE_COUPLING_PAPER, and for all `hands` (hand_count) no spring, no injected
 * damping and no controller between body and hand. The safety stages stay. CRUMBLE_E_NULL, _UNINITIALIZED, _VERSION.
 * [any] */
CRUMBLE_API crumble_result crumble_loop_apply_paper_preset(crumble_loop_def *def, crumble_hand_def *hands,
                                                           uint32_t hand_count);
/* A loop that does not run yet. `def` may be NULL: defaults. `hands`: hand_count, 1 to CRUMBLE_MOST_HANDS.
 * CRUMBLE_E_INVALID_VALUE, _OUT_OF_RANGE (a field; no such tool; a tick that does not fit the simulation's tau),
 * _BAD_POSE (workspace), _UNINITIALIZED, _VERSION, _EMPTY (no hands), _TOO_LARGE (too many), _NULL, _BAD_HANDLE,
 * _STALE_HANDLE or _BUSY (also of a device: the text names the hand), _STATE (two hands with one tool or device;
 * body_thread with coupling direct), _UNSUPPORTED (no device drives), _NO_MEMORY, _DEVICE_LOST (the thread of a
 * servo-driven device does not start). [one] in the simulation and the devices */
CRUMBLE_API crumble_result crumble_loop_create(crumble_sim sim, const crumble_loop_def *def,
                                               const crumble_hand_def *hands, uint32_t hand_count, crumble_loop *loop);
/* Stops it first, and sends zero to every device once more. NULL is allowed and does nothing. CRUMBLE_E_STATE (from
 * within a device's callback), _BUSY (also of the simulation or a device). [one] */
CRUMBLE_API crumble_result crumble_loop_destroy(crumble_loop loop);
/* Begins to tick; hands wait as at the beginning. With CRUMBLE_DRIVER_HOST it begins the watchdog and the body's
 * thread. CRUMBLE_E_STATE (it runs), _BUSY (also of the simulation or a device), _DEVICE_LOST
 * (a custom device's `start` failed), _INTERNAL (no thread from the system), _NO_MEMORY. [one] */
CRUMBLE_API crumble_result crumble_loop_start(crumble_loop loop);
/* Returns when the last tick is over and every device has been sent zero; the simulation can be stepped by hand again.
 * After ticks without start it sends the zeros too. CRUMBLE_E_STATE (from within a device's callback), _NO_MEMORY (it
 * is stopped, but a recording found no memory and was dropped). [one] */
CRUMBLE_API crumble_result crumble_loop_stop(crumble_loop loop);
/* One tick, with CRUMBLE_DRIVER_HOST, with or without start; a hand that waits, or has no force, is no error. Takes no
 * memory but while recording. CRUMBLE_E_STATE (another driver; body_thread without start), _BUSY (also of the
 * simulation or a device), _NO_MEMORY (while recording: it is done, the recording is dropped). [one] */
CRUMBLE_API crumble_result crumble_loop_tick(crumble_loop loop);
/* Where tool (or, behind the tools, attachment) `tool` stands, which no hand moves; the scene's origin until then.
 * CRUMBLE_E_OUT_OF_RANGE (no such tool), _STATE (a hand moves it; the loop runs), _BAD_POSE. [one] */
CRUMBLE_API crumble_result crumble_loop_place(crumble_loop loop, uint32_t tool, const crumble_pose *pose);
/* What became of the thread's options, as "SCHED_FIFO 80", or why not; "" where the thread is not ours. `dst` receives
 * the text and a zero behind it; `dst_bytes` and `needed` as in crumble_sim_copy. CRUMBLE_E_BUFFER_TOO_SMALL. [one] */
CRUMBLE_API crumble_result crumble_loop_get_scheduling(crumble_loop loop, char *dst, uint64_t dst_bytes,
                                                       uint64_t *needed);

/* The rest never waits for the loop, nor the loop for it. */

/* Writes 1 between start and stop, else 0. [any] */
CRUMBLE_API crumble_result crumble_loop_is_running(crumble_loop loop, uint32_t *running);
/* CRUMBLE_E_UNINITIALIZED, _VERSION (struct_size). [any] */
CRUMBLE_API crumble_result crumble_loop_get_status(crumble_loop loop, crumble_loop_status *status);
/* CRUMBLE_E_OUT_OF_RANGE (no such hand), _UNINITIALIZED, _VERSION (struct_size). [any] */
CRUMBLE_API crumble_result crumble_loop_get_hand(crumble_loop loop, uint32_t hand, crumble_hand_status *status);
/* CRUMBLE_E_UNINITIALIZED, _VERSION (struct_size). [any] */
CRUMBLE_API crumble_result crumble_loop_get_times(crumble_loop loop, crumble_loop_times *times);
/* What in the definition may be felt as a fault of the loop: damping that the device cannot give, ... Of
 * crumble_loop_status.warning_count texts the one with number `index`, as crumble_loop_get_scheduling gives its text.
 * CRUMBLE_E_OUT_OF_RANGE (index), _BUFFER_TOO_SMALL. [any] */
CRUMBLE_API crumble_result crumble_loop_get_warning(crumble_loop loop, uint32_t index, char *dst, uint64_t dst_bytes,
                                                    uint64_t *needed);
/* The simulation's definition, a tool, a tool's friction, in mid-run: as crumble_sim_configure, _set_tool and
 * _set_friction, worked out in the thread that calls; the change is made between two steps, and the loop does not wait
 * for it. Several are made in their order, one before each step; crumble_loop_stop makes those that wait. While the
 * loop does not run they are made at once.
 * Errors as these; CRUMBLE_E_STATE (also: 64 changes wait for a step). [any] */
CRUMBLE_EXPERIMENTAL crumble_result crumble_loop_configure(crumble_loop loop, const crumble_sim_def *def);
CRUMBLE_EXPERIMENTAL crumble_result crumble_loop_set_tool(crumble_loop loop, uint32_t tool,
                                                          const crumble_tool_def *def);
CRUMBLE_EXPERIMENTAL crumble_result crumble_loop_set_friction(crumble_loop loop, uint32_t tool, double static_friction,
                                                              double dynamic_friction);
/* No force on any hand from the next tick on, until its fault is reset. [any] */
CRUMBLE_API crumble_result crumble_loop_halt(crumble_loop loop);
/* A hand that is faulted waits again from the next tick on, and gets its force back by the ramp. Of another: nothing.
 * CRUMBLE_E_OUT_OF_RANGE (no such hand). [any] */
CRUMBLE_API crumble_result crumble_loop_reset_fault(crumble_loop loop, uint32_t hand);
/* "device_lost" and so on, and the same as a sentence for people; "unknown" or a sentence that says so for a number
 * that is no CRUMBLE_FAULT_. Static text. [any] */
CRUMBLE_API const char *crumble_fault_name(uint32_t fault);
CRUMBLE_API const char *crumble_fault_reason(uint32_t fault);

#ifdef __cplusplus
}
#endif

#endif

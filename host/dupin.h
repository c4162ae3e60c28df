/* Dupin's C interface: CAD models drawn from their exact surfaces, in a program of any language.
 *
 *   dupin_prepared* part = NULL;
 *   dupin_job* job = NULL;
 *   dupin_job_load("part.step", NULL, NULL, &job);            // reads on a thread of its own
 *   if (dupin_job_result(job, &part) != DUPIN_OK) puts(dupin_last_message());
 *   dupin_scene* scene = NULL;
 *   dupin_scene_create(my_get_proc_address, NULL, &scene);    // in the current OpenGL context
 *   dupin_scene_add(scene, part, NULL, &object);
 *   dupin_scene_draw(scene, &view, NULL, NULL);               // each frame
 *
 * ABI. Handles are opaque; structs that may grow begin with their size, which the caller sets (DUPIN_INIT);
 * nothing is thrown across; what is declared here stays as it is as long as DUPIN_ABI does. Strings are
 * UTF-8.
 *
 * Failure. Functions return a status; other than DUPIN_OK, dupin_last_message() has one line that says why,
 * on the same thread. Outputs are then left alone, and so is the OpenGL context.
 *
 * Ownership. What a function puts into an output is the caller's, who frees it with the function named so;
 * freeing NULL does nothing. Models and prepared models never change: any threads may share them, and
 * whatever was made from one keeps it alive. A job may be asked by any thread. A scene or builder is one
 * thread's at a time, and a scene's context must be current for create, draw, pick, picture and free. Lengths
 * are the model's, angles radians, matrices column-major as OpenGL's, colors linear light with straight
 * alpha. */
#ifndef DUPIN_H
#define DUPIN_H

#include <stddef.h>
#include <stdint.h>

#define DUPIN_ABI 1

#if defined(__GNUC__)
#define DUPIN_API __attribute__((visibility("default")))
#else
#define DUPIN_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

typedef enum {
  DUPIN_OK = 0,
  DUPIN_INVALID_ARGUMENT = 1, /* what was asked for is contradictory or out of range */
  DUPIN_UNREADABLE = 2,       /* a file is missing, damaged, empty or of an unknown kind */
  DUPIN_PARTIAL = 3,
  DUPIN_LIMIT = 4,     /* of time, memory or size */
  DUPIN_NO_DEVICE = 5, /* no OpenGL 3.3 */
  DUPIN_CANNOT_WRITE = 6,
  DUPIN_CANCELLED = 7 /* the progress callback or dupin_job_cancel said so */
} dupin_status;

#define DUPIN_WHOLE 0xffffffffu /* all instances of an object, or all faces of an instance */
/* For structs that begin with their size:  dupin_draw_options options = DUPIN_INIT(dupin_draw_options);
 * What is 0 then has its default. */
#define DUPIN_INIT(type) \
  { .size = sizeof(type) }

typedef struct dupin_model dupin_model;       /* exact faces, as a file or a host has them */
typedef struct dupin_builder dupin_builder;   /* makes a model from a host's own surfaces */
typedef struct dupin_prepared dupin_prepared; /* a model with all that takes time before it can be drawn */
typedef struct dupin_job dupin_job;           /* reading and preparing on a thread */
typedef struct dupin_scene dupin_scene;       /* models in an OpenGL context */
typedef struct dupin_context dupin_context;   /* an OpenGL context without a window */

DUPIN_API const char* dupin_version(void); /* "0.1.0" */
DUPIN_API int dupin_abi(void);             /* DUPIN_ABI of the library that runs */
DUPIN_API const char* dupin_last_message(void);
/* Threads that the library uses at once in this process; 0: one a core. */
DUPIN_API void dupin_set_threads(int threads);

/* Called with what is being done and how far it has come, 0 … 1, from any thread; 0 stops the work. */
typedef int (*dupin_progress)(void* user, const char* stage, double fraction);

/* ---- models */

typedef struct {
  size_t size;
  double time_limit_seconds; /* 0: none */
  uint64_t memory_limit;     /* of the reading process, bytes; 0: most of the machine's */
  const char* assumed_unit;  /* of files that name none: mm cm m inch ft um; NULL: mm */
  const char* reader;        /* the reader's executable; NULL: $DUPIN_READER, or where it was installed */
  dupin_progress progress;
  void* user;
} dupin_load_options;

/* STEP, IGES, BREP, FCStd, OBJ, PLY, STL or OFF, read in a process of its own. */
DUPIN_API dupin_status dupin_model_load(const char* path, const dupin_load_options* options,
                                        dupin_model** model);
/* The same from a file's bytes in memory (Linux). */
DUPIN_API dupin_status dupin_model_load_memory(const void* bytes, size_t size,
                                               const dupin_load_options* options, dupin_model** model);
DUPIN_API void dupin_model_free(dupin_model* model);

typedef struct {
  size_t size;
  uint32_t parts, instances;
  uint64_t faces;   /* of all instances; those that could be read */
  uint64_t skipped; /* of all instances; those that could not */
  double box[6];    /* least x, y, z, largest x, y, z; least > largest if there is nothing */
  const char *source, *format, *unit; /* live as long as the model */
} dupin_model_info;
DUPIN_API dupin_status dupin_model_get_info(const dupin_model* model, dupin_model_info* info);
/* NULL where there is no such instance or entry. They live as long as the model. */
DUPIN_API const char* dupin_model_instance_name(const dupin_model* model, uint32_t instance);
DUPIN_API const char* dupin_model_part_name(const dupin_model* model, uint32_t instance);
/* Faces of the instance's part; 0 where there is no such instance. */
DUPIN_API uint32_t dupin_model_face_count(const dupin_model* model, uint32_t instance);
/* What could not be read, or was repaired or assumed: one line for each number from 0 on. */
DUPIN_API const char* dupin_model_note(const dupin_model* model, uint32_t number);

/* ---- models from a host's own geometry. Parametrisations are those of ISO 10303-42. */

typedef enum {
  DUPIN_LINE = 0,    /* origin + t x */
  DUPIN_CIRCLE = 1,  /* origin + a (cos t x + sin t y), x and y unit and perpendicular */
  DUPIN_ELLIPSE = 2, /* origin + a cos t x + b sin t y */
  DUPIN_BSPLINE_CURVE = 3
} dupin_curve_kind;

typedef struct {
  size_t size;
  dupin_curve_kind kind;
  double origin[3], x[3], y[3]; /* in the parameter plane the third number is not used */
  double a, b;
  int degree, periodic;
  size_t pole_count, knot_count; /* all knots, multiple ones repeated: pole_count + degree + 1 */
  const double* poles;           /* 3 numbers each, in the parameter plane 2 */
  const double* weights;         /* NULL: all 1 */
  const double* knots;
} dupin_curve;

typedef enum {
  DUPIN_PLANE = 0,    /* origin + u x + v y, y = z × x */
  DUPIN_CYLINDER = 1, /* origin + a (cos u x + sin u y) + v z */
  DUPIN_CONE = 2,     /* origin + (a + v sin b)(cos u x + sin u y) + v cos b z */
  DUPIN_SPHERE = 3,   /* origin + a cos v (cos u x + sin u y) + a sin v z */
  DUPIN_TORUS = 4,    /* origin + (a + b cos v)(cos u x + sin u y) + b sin v z */
  DUPIN_BSPLINE_SURFACE = 5,
  DUPIN_REVOLUTION = 6, /* profile(v) turned by u about the axis z through origin */
  DUPIN_EXTRUSION = 7   /* profile(u) + v z */
} dupin_surface_kind;

typedef struct {
  size_t size;
  dupin_surface_kind kind;
  double origin[3], x[3], z[3]; /* unit, perpendicular */
  double a, b;
  const dupin_curve* profile;
  int degree_u, degree_v, periodic_u, periodic_v;
  size_t count_u, count_v, knot_count_u, knot_count_v;
  const double* poles;   /* 3 numbers each; pole (i, j) is number i · count_v + j, i along u */
  const double* weights; /* NULL: all 1 */
  const double *knots_u, *knots_v;
} dupin_surface;

typedef struct {
  size_t size;
  uint32_t surface;
  int reversed;      /* the outward normal is −(Su × Sv) */
  double uv_box[4];  /* least u, v, largest u, v: contains the loops; the whole face where it has none */
  double tolerance;  /* of its loops, model units */
  const float* rgba; /* NULL: its part's */
  const char* name;  /* or NULL */
} dupin_face;

typedef struct {
  size_t size;
  uint32_t edge;
  int new_loop; /* begins the face's next loop; each is closed, the face on its left in the parameter plane */
  int reversed; /* the loop runs from the edge's t1 to its t0 */
  int seam;     /* the edge bounds this face twice */
  dupin_curve curve; /* in the surface's parameters, with the edge's own parameter */
} dupin_trim;

DUPIN_API dupin_status dupin_builder_create(const char* source, dupin_builder** builder);
DUPIN_API void dupin_builder_free(dupin_builder* builder);
/* `closed`: its faces bound a solid, normals outward. Each adds one and gives its number. */
DUPIN_API dupin_status dupin_builder_add_part(dupin_builder* builder, const char* name, const float* rgba,
                                              int closed, uint32_t* part);
DUPIN_API dupin_status dupin_builder_add_surface(dupin_builder* builder, uint32_t part,
                                                 const dupin_surface* surface, uint32_t* number);
/* `curve`: NULL for a point (a pole, a collapsed side). `smooth`: no feature line. */
DUPIN_API dupin_status dupin_builder_add_edge(dupin_builder* builder, uint32_t part, const dupin_curve* curve,
                                              double t0, double t1, double tolerance, int smooth,
                                              uint32_t* number);
DUPIN_API dupin_status dupin_builder_add_face(dupin_builder* builder, uint32_t part, const dupin_face* face,
                                              uint32_t* number);
DUPIN_API dupin_status dupin_builder_add_trim(dupin_builder* builder, uint32_t part, uint32_t face,
                                              const dupin_trim* trim);
/* Triangles, beside or instead of faces: 3 numbers a vertex, 3 indices each. */
DUPIN_API dupin_status dupin_builder_add_mesh(dupin_builder* builder, uint32_t part, const double* vertices,
                                              size_t vertex_count, const uint32_t* triangles,
                                              size_t triangle_count);
/* Without any, each part stands once where it is. `matrix`: 16 numbers, or NULL. */
DUPIN_API dupin_status dupin_builder_add_instance(dupin_builder* builder, uint32_t part, const double* matrix,
                                                  const char* name, uint32_t* number);
/* Checks everything, and says the first thing that is wrong. The builder is empty afterwards. */
DUPIN_API dupin_status dupin_builder_finish(dupin_builder* builder, dupin_model** model);

/* ---- preparing */

typedef struct {
  size_t size;
  double tolerance;        /* largest distance from the surface, model units; 0: 1/4000 of the diagonal */
  double normal_tolerance; /* 0: a quarter of a degree */
  dupin_progress progress;
  void* user;
} dupin_prepare_options;

DUPIN_API dupin_status dupin_prepare(const dupin_model* model, const dupin_prepare_options* options,
                                     dupin_prepared** prepared);
DUPIN_API void dupin_prepared_free(dupin_prepared* prepared);
/* The model, to be freed too. */
DUPIN_API dupin_status dupin_prepared_model(const dupin_prepared* prepared, dupin_model** model);

/* Either options may be NULL; their callbacks are called on the job's threads. */
DUPIN_API dupin_status dupin_job_load(const char* path, const dupin_load_options* load,
                                      const dupin_prepare_options* prepare, dupin_job** job);
DUPIN_API dupin_status dupin_job_prepare(const dupin_model* model, const dupin_prepare_options* prepare,
                                         dupin_job** job);
/* Of the stage that runs now; `stage`, if any, gets its name, cut to `capacity` bytes with their 0. */
DUPIN_API double dupin_job_fraction(const dupin_job* job, char* stage, size_t capacity);
DUPIN_API int dupin_job_done(const dupin_job* job);
DUPIN_API void dupin_job_cancel(dupin_job* job);
/* Waits for it. */
DUPIN_API dupin_status dupin_job_result(const dupin_job* job, dupin_prepared** prepared);
DUPIN_API void dupin_job_free(dupin_job* job); /* cancels, and waits */

/* ---- drawing */

typedef void* (*dupin_get_proc_address)(void* user, const char* name);

/* For programs that have none: OpenGL 3.3 core, current on this thread. */
DUPIN_API dupin_status dupin_context_create(dupin_context** context);
DUPIN_API void dupin_context_free(dupin_context* context);
DUPIN_API void* dupin_context_get_proc_address(void* context, const char* name); /* for `user` = context */

typedef struct {
  double view[16], projection[16];
  int viewport[4]; /* x, y, width, height */
} dupin_view;

typedef struct {
  double eye[3], target[3], up[3];
  double fov_degrees; /* vertical; 0: parallel */
  double height;      /* of the picture in model units; parallel only */
  int width, pixels_high;
} dupin_camera;

typedef enum {
  DUPIN_LIT = 0,
  DUPIN_NORMAL,
  DUPIN_K1,
  DUPIN_K2,
  DUPIN_MEAN,
  DUPIN_GAUSSIAN,
  DUPIN_ZEBRA,
  DUPIN_FACE,
  DUPIN_PRIMITIVE
} dupin_shading;

typedef struct {
  double position[3]; /* model space */
  float rgb[3];
} dupin_light;

typedef struct {
  size_t size;
  dupin_shading shading;
  int no_edges;            /* feature edges are drawn otherwise */
  double edge_width;       /* pixels; 0: 1.2 */
  int samples;             /* a pixel; 0: 1 */
  const float* color;      /* rgba instead of every color; NULL: the models' */
  const float* background; /* rgba, pictures only; NULL: transparent */
  size_t light_count;      /* 0: a head, a key and a fill light around the camera */
  const dupin_light* lights;
  size_t section_count; /* planes a b c d: only points with a x + b y + c z + d >= 0 are drawn */
  const double* sections;
  double curvature_scale; /* |curvature| of the full color; 0: by the scene's size */
} dupin_draw_options;

typedef struct {
  size_t size;
  uint32_t primitives; /* drawn */
  double bound_px;     /* certified: no drawn point is farther from the surface on the screen */
  double milliseconds;
} dupin_frame_stats;

DUPIN_API dupin_status dupin_scene_create(dupin_get_proc_address get_proc_address, void* user,
                                          dupin_scene** scene);
DUPIN_API void dupin_scene_free(dupin_scene* scene);
/* `matrix`: 16 numbers, or NULL. Objects have numbers from 1 on. */
DUPIN_API dupin_status dupin_scene_add(dupin_scene* scene, const dupin_prepared* model, const double* matrix,
                                       uint32_t* object);
DUPIN_API dupin_status dupin_scene_replace(dupin_scene* scene, uint32_t object, const dupin_prepared* model);
DUPIN_API dupin_status dupin_scene_remove(dupin_scene* scene, uint32_t object);
DUPIN_API dupin_status dupin_scene_place(dupin_scene* scene, uint32_t object, const double* matrix);
/* Of an object, or (0) of all. */
DUPIN_API dupin_status dupin_scene_box(const dupin_scene* scene, uint32_t object, double box[6]);
/* `instance` and `face`: DUPIN_WHOLE for all; what is said of the smaller goes before the larger. */
DUPIN_API dupin_status dupin_scene_set_visible(dupin_scene* scene, uint32_t object, uint32_t instance,
                                               uint32_t face, int visible);
/* NULL: as the file has it; not highlighted. */
DUPIN_API dupin_status dupin_scene_set_color(dupin_scene* scene, uint32_t object, uint32_t instance,
                                             uint32_t face, const float* rgba);
DUPIN_API dupin_status dupin_scene_set_highlight(dupin_scene* scene, uint32_t object, uint32_t instance,
                                                 uint32_t face, const float* rgba);

/* Into the framebuffer that is bound for drawing, against and into its depth buffer. `stats` may be NULL. */
DUPIN_API dupin_status dupin_scene_draw(dupin_scene* scene, const dupin_view* view,
                                        const dupin_draw_options* options, dupin_frame_stats* stats);
/* Prepares what the view sees to `tolerance_px` pixels, on a thread; the first frame after that has it. */
DUPIN_API dupin_status dupin_scene_refine(dupin_scene* scene, const dupin_view* view, double tolerance_px);
DUPIN_API int dupin_scene_refining(const dupin_scene* scene);
/* width · pixels_high pixels from the top left: 4 bytes each (sRGB, straight alpha), and depths along the
 * view axis (infinite where there is nothing); either may be NULL. */
DUPIN_API dupin_status dupin_scene_picture(dupin_scene* scene, const dupin_camera* camera,
                                           const dupin_draw_options* options, uint8_t* rgba, float* depth);

typedef struct {
  size_t size;
  uint32_t object, instance, face; /* object 0: there is nothing */
  int32_t edge;                    /* of the part, seen within 4 pixels; -1: none */
  double edge_distance_px;
  double point[3], normal[3], depth;
  double k1, k2, direction[3], u, v; /* of the exact surface; NaN for meshes */
  double radius;                     /* NaN where there is none */
  char surface[16];                  /* "plane", "cylinder", …, "mesh" */
} dupin_hit;

/* Pixels count from the viewport's lower left corner. */
DUPIN_API dupin_status dupin_scene_pick(dupin_scene* scene, const dupin_view* view, int x, int y,
                                        const dupin_draw_options* options, dupin_hit* hit);
typedef struct {
  uint32_t object, instance, face;
} dupin_target;
/* The faces seen in x, y, width, height. `count` gets how many; at most `capacity` are put into `targets`. */
DUPIN_API dupin_status dupin_scene_pick_rectangle(dupin_scene* scene, const dupin_view* view,
                                                  const int rectangle[4], const dupin_draw_options* options,
                                                  dupin_target* targets, size_t capacity, size_t* count);

#ifdef __cplusplus
}
#endif
#endif

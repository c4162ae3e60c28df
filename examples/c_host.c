/* The C interface from a C program: a model made in memory (a plate with a round hole, and a ball), prepared
 * on a thread, drawn, picked and sectioned in an OpenGL context.
 *
 *   c_host [OUT.ppm] [MODEL]
 *
 * With MODEL that file is drawn in place of the plate. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "dupin.h"

#define SIZE 400
static const double kPi = 3.14159265358979323846;

static void must(dupin_status status, const char* what) {
  if (status == DUPIN_OK) return;
  fprintf(stderr, "c_host: %s: %s\n", what, dupin_last_message());
  exit(1);
}

static dupin_curve line(double x, double y, double z, double dx, double dy, double dz) {
  dupin_curve curve = DUPIN_INIT(dupin_curve);
  curve.kind = DUPIN_LINE;
  curve.origin[0] = x, curve.origin[1] = y, curve.origin[2] = z;
  curve.x[0] = dx, curve.x[1] = dy, curve.x[2] = dz;
  return curve;
}

static dupin_curve circle(double radius, double turn) {
  dupin_curve curve = DUPIN_INIT(dupin_curve);
  curve.kind = DUPIN_CIRCLE;
  curve.x[0] = 1, curve.y[1] = turn, curve.a = radius;
  return curve;
}

/* One edge of the plate's face. In its plane, parameters are x and y: the same curve serves for both. */
static void add_side(dupin_builder* builder, uint32_t part, uint32_t face, const dupin_curve* curve,
                     double t1, int new_loop) {
  dupin_trim trim = DUPIN_INIT(dupin_trim);
  must(dupin_builder_add_edge(builder, part, curve, 0, t1, 1e-7, 0, &trim.edge), "edge");
  trim.new_loop = new_loop;
  trim.curve = *curve;
  must(dupin_builder_add_trim(builder, part, face, &trim), "trim");
}

static void add_plate(dupin_builder* builder) {
  const float red[4] = {0.7f, 0.1f, 0.1f, 1};
  const double corners[5][2] = {{-2, -2}, {2, -2}, {2, 2}, {-2, 2}, {-2, -2}};
  uint32_t part, surface, face;
  dupin_surface plane = DUPIN_INIT(dupin_surface);
  dupin_face border = DUPIN_INIT(dupin_face);
  dupin_curve hole = circle(0.8, -1);
  int i;
  must(dupin_builder_add_part(builder, "plate", red, 0, &part), "part");
  plane.kind = DUPIN_PLANE;
  plane.x[0] = 1, plane.z[2] = 1;
  must(dupin_builder_add_surface(builder, part, &plane, &surface), "plane");
  border.surface = surface;
  border.uv_box[0] = border.uv_box[1] = -2, border.uv_box[2] = border.uv_box[3] = 2;
  border.tolerance = 1e-7;
  must(dupin_builder_add_face(builder, part, &border, &face), "face");
  for (i = 0; i < 4; ++i) {
    const double* a = corners[i];
    const double* b = corners[i + 1];
    const dupin_curve side = line(a[0], a[1], 0, b[0] - a[0], b[1] - a[1], 0);
    add_side(builder, part, face, &side, 1, i == 0);
  }
  add_side(builder, part, face, &hole, 2 * kPi, 1);
}

static void add_ball(dupin_builder* builder) {
  const float green[4] = {0.1f, 0.5f, 0.2f, 1};
  uint32_t part, surface, face;
  dupin_surface sphere = DUPIN_INIT(dupin_surface);
  dupin_face whole = DUPIN_INIT(dupin_face);
  must(dupin_builder_add_part(builder, "ball", green, 1, &part), "part");
  sphere.kind = DUPIN_SPHERE;
  sphere.origin[0] = 1.2, sphere.origin[2] = 0.6, sphere.x[0] = 1, sphere.z[2] = 1, sphere.a = 0.6;
  must(dupin_builder_add_surface(builder, part, &sphere, &surface), "sphere");
  whole.surface = surface;
  whole.uv_box[1] = -kPi / 2, whole.uv_box[2] = 2 * kPi, whole.uv_box[3] = kPi / 2;
  must(dupin_builder_add_face(builder, part, &whole, &face), "face");
}

static dupin_job* start(const char* file) {
  dupin_job* job = NULL;
  if (file) {
    must(dupin_job_load(file, NULL, NULL, &job), file);
  } else {
    dupin_builder* builder = NULL;
    dupin_model* model = NULL;
    must(dupin_builder_create("plate and ball", &builder), "builder");
    add_plate(builder);
    add_ball(builder);
    must(dupin_builder_finish(builder, &model), "model");
    must(dupin_job_prepare(model, NULL, &job), "job");
    dupin_model_free(model); /* the job keeps what it needs */
    dupin_builder_free(builder);
  }
  return job;
}

static void write_picture(const char* path, const uint8_t* rgba) {
  FILE* file = fopen(path, "wb");
  int i;
  if (!file) must(DUPIN_CANNOT_WRITE, path);
  fprintf(file, "P6\n%d %d\n255\n", SIZE, SIZE);
  for (i = 0; i < SIZE * SIZE; ++i) fwrite(rgba + 4 * i, 1, 3, file);
  fclose(file);
}

/* What is at a pixel of the picture, seen straight from above, 5 units from side to side. */
static dupin_hit hit_at(dupin_scene* scene, double x, double y) {
  dupin_view view = {{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -10, 1},
                     {0.4, 0, 0, 0, 0, 0.4, 0, 0, 0, 0, -0.1, 0, 0, 0, -1, 1},
                     {0, 0, SIZE, SIZE}};
  dupin_hit hit = DUPIN_INIT(dupin_hit);
  const int column = (int)((x + 2.5) / 5 * SIZE), row = (int)((y + 2.5) / 5 * SIZE);
  must(dupin_scene_pick(scene, &view, column, row, NULL, &hit), "pick");
  return hit;
}

static void expect(int holds, const char* what) {
  if (holds) return;
  fprintf(stderr, "c_host: %s\n", what);
  exit(1);
}

static void look_closer(dupin_scene* scene, uint32_t object) {
  const dupin_hit hole = hit_at(scene, 0, 0), plate = hit_at(scene, -1.5, 1), rim = hit_at(scene, -0.81, 0);
  dupin_hit ball = hit_at(scene, 1.3, 0);
  expect(hole.object == 0, "the hole is not open");
  expect(plate.object == object && !strcmp(plate.surface, "plane") && plate.edge < 0,
         "the plate is not seen");
  expect(rim.edge == 4, "the hole's edge is not picked");
  expect(!strcmp(ball.surface, "sphere") && fabs(ball.radius - 0.6) < 1e-9, "the ball is not picked");
  expect(fabs(ball.k1 + 1 / 0.6) < 1e-4 && fabs(ball.normal[2]) > 0.9, "the ball has other curvatures");
  must(dupin_scene_set_visible(scene, object, 1, DUPIN_WHOLE, 0), "hide");
  ball = hit_at(scene, 1.3, 0);
  expect(!strcmp(ball.surface, "plane"), "the ball was not hidden");
  must(dupin_scene_set_visible(scene, object, 1, DUPIN_WHOLE, 1), "show");
  expect(dupin_scene_set_visible(scene, object, 7, DUPIN_WHOLE, 0) == DUPIN_INVALID_ARGUMENT,
         "no such instance");
  expect(strlen(dupin_last_message()) > 0, "no message");
}

int main(int argc, char** argv) {
  static uint8_t rgba[4 * SIZE * SIZE];
  const float white[4] = {1, 1, 1, 1};
  dupin_job* job;
  dupin_prepared* prepared = NULL;
  dupin_context* context = NULL;
  dupin_scene* scene = NULL;
  dupin_camera camera;
  dupin_draw_options options = DUPIN_INIT(dupin_draw_options);
  double box[6], size;
  uint32_t object = 0;
  int i;

  expect(dupin_abi() == DUPIN_ABI, "the library is of another ABI");
  job = start(argc > 2 ? argv[2] : NULL);
  must(dupin_job_result(job, &prepared), "load"); /* a program with a window asks dupin_job_done each frame */
  must(dupin_context_create(&context), "context"); /* … and has a context */
  must(dupin_scene_create(dupin_context_get_proc_address, context, &scene), "scene");
  must(dupin_scene_add(scene, prepared, NULL, &object), "add");
  dupin_prepared_free(prepared);
  if (argc < 3) look_closer(scene, object);

  must(dupin_scene_box(scene, 0, box), "box");
  memset(&camera, 0, sizeof camera);
  size = sqrt(pow(box[3] - box[0], 2) + pow(box[4] - box[1], 2) + pow(box[5] - box[2], 2));
  for (i = 0; i < 3; ++i) camera.target[i] = (box[i] + box[i + 3]) / 2;
  camera.eye[0] = camera.target[0] + size, camera.eye[1] = camera.target[1] - size,
  camera.eye[2] = camera.target[2] + size;
  camera.up[2] = 1, camera.fov_degrees = 35;
  camera.width = camera.pixels_high = SIZE;
  options.samples = 4;
  options.background = white;
  must(dupin_scene_picture(scene, &camera, &options, rgba, NULL), "picture");
  if (argc > 1) write_picture(argv[1], rgba);

  dupin_scene_free(scene);
  dupin_context_free(context);
  dupin_job_free(job);
  return 0;
}

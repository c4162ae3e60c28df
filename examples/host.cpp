// A host that owns its OpenGL context, camera and depth buffer, draws something of its own, and lets the
// library draw a CAD model into the same picture: each hides the other where it is nearer.
//
//   host MODEL OUT.png [egl|osmesa]
//
// A program with a window does the same with the context that its toolkit made: all that the library needs is
// that context's getProcAddress, the two camera matrices and the viewport.
#include <GL/glcorearb.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "../cad_import/cad_import.h"
#include "../render/context.h"
#include "../render/image.h"
#include "../render/renderer.h"
#include "../sampling/sampler.h"

namespace {

constexpr int kWidth = 800, kHeight = 600;
constexpr double kPi = 3.14159265358979323846;

/// The few OpenGL functions that this host itself uses.
struct HostGl {
  explicit HostGl(const dupin::GetProcAddress& get) {
    const auto load = [&](auto& function, const char* name) {
      function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(get(name));
    };
    load(create_shader, "glCreateShader"), load(shader_source, "glShaderSource"),
        load(compile_shader, "glCompileShader");
    load(create_program, "glCreateProgram"), load(attach_shader, "glAttachShader"),
        load(link_program, "glLinkProgram");
    load(use_program, "glUseProgram"), load(get_uniform, "glGetUniformLocation"),
        load(uniform_matrix, "glUniformMatrix4fv");
    load(gen_framebuffers, "glGenFramebuffers"), load(bind_framebuffer, "glBindFramebuffer");
    load(gen_renderbuffers, "glGenRenderbuffers"), load(bind_renderbuffer, "glBindRenderbuffer");
    load(renderbuffer_storage, "glRenderbufferStorage"),
        load(framebuffer_renderbuffer, "glFramebufferRenderbuffer");
    load(gen_buffers, "glGenBuffers"), load(bind_buffer, "glBindBuffer"), load(buffer_data, "glBufferData");
    load(gen_arrays, "glGenVertexArrays"), load(bind_array, "glBindVertexArray");
    load(attribute, "glVertexAttribPointer"), load(enable_attribute, "glEnableVertexAttribArray");
    load(enable, "glEnable"), load(viewport, "glViewport"), load(clear_color, "glClearColor"),
        load(clear, "glClear");
    load(draw_arrays, "glDrawArrays"), load(read_pixels, "glReadPixels");
  }
  PFNGLCREATESHADERPROC create_shader;
  PFNGLSHADERSOURCEPROC shader_source;
  PFNGLCOMPILESHADERPROC compile_shader;
  PFNGLCREATEPROGRAMPROC create_program;
  PFNGLATTACHSHADERPROC attach_shader;
  PFNGLLINKPROGRAMPROC link_program;
  PFNGLUSEPROGRAMPROC use_program;
  PFNGLGETUNIFORMLOCATIONPROC get_uniform;
  PFNGLUNIFORMMATRIX4FVPROC uniform_matrix;
  PFNGLGENFRAMEBUFFERSPROC gen_framebuffers;
  PFNGLBINDFRAMEBUFFERPROC bind_framebuffer;
  PFNGLGENRENDERBUFFERSPROC gen_renderbuffers;
  PFNGLBINDRENDERBUFFERPROC bind_renderbuffer;
  PFNGLRENDERBUFFERSTORAGEPROC renderbuffer_storage;
  PFNGLFRAMEBUFFERRENDERBUFFERPROC framebuffer_renderbuffer;
  PFNGLGENBUFFERSPROC gen_buffers;
  PFNGLBINDBUFFERPROC bind_buffer;
  PFNGLBUFFERDATAPROC buffer_data;
  PFNGLGENVERTEXARRAYSPROC gen_arrays;
  PFNGLBINDVERTEXARRAYPROC bind_array;
  PFNGLVERTEXATTRIBPOINTERPROC attribute;
  PFNGLENABLEVERTEXATTRIBARRAYPROC enable_attribute;
  PFNGLENABLEPROC enable;
  PFNGLVIEWPORTPROC viewport;
  PFNGLCLEARCOLORPROC clear_color;
  PFNGLCLEARPROC clear;
  PFNGLDRAWARRAYSPROC draw_arrays;
  PFNGLREADPIXELSPROC read_pixels;
};

using Matrix = std::array<double, 16>;  // by columns

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix m{};
  for (std::size_t c = 0; c < 4; ++c)
    for (std::size_t r = 0; r < 4; ++r)
      for (std::size_t k = 0; k < 4; ++k) m[4 * c + r] += a[4 * k + r] * b[4 * c + k];
  return m;
}

Matrix look_at(const dupin::Vec3& eye, const dupin::Vec3& target) {
  dupin::Camera camera;
  camera.eye = eye;
  camera.target = target;
  const auto [x, y, z] = dupin::camera_axes(camera);
  return {x.x, y.x, z.x, 0, x.y, y.y, z.y, 0, x.z, y.z, z.z, 0, -dot(x, eye), -dot(y, eye), -dot(z, eye), 1};
}

Matrix perspective(double fov_degrees, double aspect, double near, double far) {
  const double f = 1 / std::tan(fov_degrees * kPi / 360);
  return {f / aspect,
          0,
          0,
          0,
          0,
          f,
          0,
          0,
          0,
          0,
          (far + near) / (near - far),
          -1,
          0,
          0,
          2 * far * near / (near - far),
          0};
}

/// Triangles with normals: a checkered ground below the box, and a ring around it that the model and it hide
/// each other with.
std::vector<float> own_scene(const dupin::Box3& box) {
  std::vector<float> v;
  const dupin::Vec3 c = box.center();
  const double size = box.diagonal(), ground = box.lo.z - 0.02 * size;
  const auto vertex = [&](const dupin::Vec3& p, const dupin::Vec3& n) {
    for (const double x : {p.x, p.y, p.z, n.x, n.y, n.z}) v.push_back(static_cast<float>(x));
  };
  for (int i = -6; i < 6; ++i)
    for (int j = -6; j < 6; ++j) {
      if ((i + j) & 1) continue;
      const double s = size / 6, x = c.x + i * s, y = c.y + j * s;
      const dupin::Vec3 corners[] = {
          {x, y, ground}, {x + s, y, ground}, {x + s, y + s, ground}, {x, y + s, ground}};
      for (const int k : {0, 1, 2, 0, 2, 3}) vertex(corners[k], {0, 0, 1});
    }
  const double large = 0.5 * size, small = 0.035 * size;
  const auto ring = [&](int i, int j) {
    const double a = i * 2 * kPi / 96, b = j * 2 * kPi / 24;
    const dupin::Vec3 out{std::cos(a), 0.35 * std::cos(a), std::sin(a)},
        n = normalized(out) * std::cos(b) + dupin::Vec3{-0.33, 0.94, 0} * std::sin(b);
    vertex(c + out * large + n * small, n);
  };
  for (int i = 0; i < 96; ++i)
    for (int j = 0; j < 24; ++j)
      ring(i, j), ring(i + 1, j), ring(i + 1, j + 1), ring(i, j), ring(i + 1, j + 1), ring(i, j + 1);
  return v;
}

class Host {
 public:
  Host(const dupin::GetProcAddress& get, const dupin::Box3& box) : gl_(get) {
    const double size = box.diagonal();
    view_ = look_at(box.center() + dupin::Vec3{0.7, -1.5, 0.9} * size, box.center());
    projection_ = perspective(35, static_cast<double>(kWidth) / kHeight, 0.2 * size, 5 * size);
    make_framebuffer();
    make_program();
    make_mesh(own_scene(box));
  }
  void draw() const {
    gl_.viewport(0, 0, kWidth, kHeight);
    gl_.clear_color(0.93F, 0.95F, 0.98F, 1);
    gl_.clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    gl_.enable(GL_DEPTH_TEST);
    gl_.use_program(program_);
    const Matrix both = product(projection_, view_);
    float m[16];
    for (int i = 0; i < 16; ++i) m[i] = static_cast<float>(both[static_cast<std::size_t>(i)]);
    gl_.uniform_matrix(gl_.get_uniform(program_, "to_clip"), 1, GL_FALSE, m);
    gl_.bind_array(array_);
    gl_.draw_arrays(GL_TRIANGLES, 0, vertices_);
  }
  dupin::HostView host_view() const { return {view_, projection_, {0, 0, kWidth, kHeight}}; }
  dupin::Image8 picture() const {
    std::vector<std::uint8_t> rows(3 * kWidth * kHeight);
    gl_.read_pixels(0, 0, kWidth, kHeight, GL_RGB, GL_UNSIGNED_BYTE, rows.data());
    dupin::Image8 image{kWidth, kHeight, 3, {}};
    for (int y = kHeight - 1; y >= 0; --y)
      image.values.insert(image.values.end(), rows.begin() + 3 * kWidth * y,
                          rows.begin() + 3 * kWidth * (y + 1));
    return image;
  }

 private:
  void make_framebuffer() {
    GLuint framebuffer = 0, buffers[2] = {};
    gl_.gen_framebuffers(1, &framebuffer);
    gl_.bind_framebuffer(GL_FRAMEBUFFER, framebuffer);
    gl_.gen_renderbuffers(2, buffers);
    const GLenum formats[] = {GL_RGBA8, GL_DEPTH_COMPONENT24},
                 attachments[] = {GL_COLOR_ATTACHMENT0, GL_DEPTH_ATTACHMENT};
    for (int i = 0; i < 2; ++i) {
      gl_.bind_renderbuffer(GL_RENDERBUFFER, buffers[i]);
      gl_.renderbuffer_storage(GL_RENDERBUFFER, formats[i], kWidth, kHeight);
      gl_.framebuffer_renderbuffer(GL_FRAMEBUFFER, attachments[i], GL_RENDERBUFFER, buffers[i]);
    }
  }
  void make_program() {
    const char* vertex =
        "#version 330 core\nlayout(location=0) in vec3 p; layout(location=1) in vec3 n; uniform mat4 "
        "to_clip; out vec3 normal;\n"
        "void main() { normal = n; gl_Position = to_clip * vec4(p, 1); }\n";
    const char* fragment =
        "#version 330 core\nin vec3 normal; out vec4 color;\n"
        "void main() { float d = 0.35 + 0.65 * abs(dot(normalize(normal), normalize(vec3(0.3, -0.5, "
        "0.8))));\n"
        "  color = vec4(d * vec3(0.80, 0.45, 0.20), 1); }\n";
    program_ = gl_.create_program();
    const std::pair<GLenum, const char*> stages[] = {{GL_VERTEX_SHADER, vertex},
                                                     {GL_FRAGMENT_SHADER, fragment}};
    for (const auto& [stage, text] : stages) {
      const GLuint shader = gl_.create_shader(stage);
      gl_.shader_source(shader, 1, &text, nullptr);
      gl_.compile_shader(shader);
      gl_.attach_shader(program_, shader);
    }
    gl_.link_program(program_);
  }
  void make_mesh(const std::vector<float>& vertices) {
    vertices_ = static_cast<GLsizei>(vertices.size() / 6);
    GLuint buffer = 0;
    gl_.gen_arrays(1, &array_);
    gl_.bind_array(array_);
    gl_.gen_buffers(1, &buffer);
    gl_.bind_buffer(GL_ARRAY_BUFFER, buffer);
    gl_.buffer_data(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(float)),
                    vertices.data(), GL_STATIC_DRAW);
    for (const GLuint i : {0U, 1U}) {
      gl_.attribute(i, 3, GL_FLOAT, GL_FALSE, 24, reinterpret_cast<const void*>(std::size_t{12} * i));
      gl_.enable_attribute(i);
    }
  }

  HostGl gl_;
  Matrix view_, projection_;
  GLuint program_ = 0, array_ = 0;
  GLsizei vertices_ = 0;
};

int fail(const dupin::Status& status) {
  std::fprintf(stderr, "host: %s\n", status.message.c_str());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return fail({dupin::StatusCode::invalid_argument, "usage: host MODEL OUT.png [egl|osmesa]"});
  const auto model = dupin::import_cad(argv[1], {});
  if (!model) return fail(model.status());
  const dupin::Box3 box = bounding_box(*model);
  dupin::SamplingOptions sampling;
  sampling.tolerance = 1e-4 * box.diagonal();
  const auto dps = dupin::sample_quadric_dps(*model, sampling);
  if (!dps) return fail(dps.status());

  // The host's own world: a context that is current, a framebuffer, something drawn.
  const std::string device = argc > 3 ? argv[3] : "auto";
  const auto context = dupin::create_context(device == "egl"      ? dupin::Device::egl
                                             : device == "osmesa" ? dupin::Device::osmesa
                                                                  : dupin::Device::automatic);
  if (!context) return fail(context.status());
  const Host host((*context)->loader(), box);
  host.draw();

  // The library's part.
  const auto renderer = dupin::Renderer::create((*context)->loader());
  if (!renderer) return fail(renderer.status());
  const auto scene = (*renderer)->upload(*model, &*dps);
  if (!scene) return fail(scene.status());
  const dupin::Status drawn = (*renderer)->draw_into_host(**scene, host.host_view(), {});
  if (!drawn.ok()) return fail(drawn);

  const dupin::Status written = dupin::write_png(argv[2], host.picture());
  return written.ok() ? 0 : fail(written);
}

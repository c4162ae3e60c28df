#include "gl_objects.h"

#include <algorithm>

#include "shader_sources.h"

namespace dupin {
namespace {

std::string full_text(const std::vector<std::string>& files, const std::vector<std::string>& defines) {
  std::string text = "#version 330 core\n";
  for (const std::string& define : defines) text += "#define " + define + "\n";
  text += shader_source("common.glsl");
  for (const std::string& file : files) {
    text += "#line 1\n";
    text += file.find('\n') == std::string::npos ? shader_source(file) : std::string_view(file);
  }
  return text;
}

/// 0 and the compiler's log in `problem` if it fails.
GLuint compile(const Gl& gl, GLenum stage, const std::vector<std::string>& files,
               const std::vector<std::string>& defines, std::string& problem) {
  const std::string text = full_text(files, defines);
  const char* source = text.c_str();
  const GLuint shader = gl.CreateShader(stage);
  gl.ShaderSource(shader, 1, &source, nullptr);
  gl.CompileShader(shader);
  GLint ok = GL_FALSE;
  gl.GetShaderiv(shader, GL_COMPILE_STATUS, &ok);
  if (ok) return shader;
  char log[2048] = "";
  gl.GetShaderInfoLog(shader, sizeof log, nullptr, log);
  problem = "shader " + files.back().substr(0, files.back().find('\n')) + ": " + log;
  gl.DeleteShader(shader);
  return 0;
}

}  // namespace

Result<GlProgram> build_program(const Gl& gl, const ProgramText& text) {
  std::string problem;
  GlProgram program(gl, gl.CreateProgram());
  const auto attach = [&](GLenum stage, const std::vector<std::string>& files) {
    const GLuint shader = compile(gl, stage, files, text.defines, problem);
    if (!shader) return;
    gl.AttachShader(program.name(), shader);
    gl.DeleteShader(shader);  // lives on with the program
  };
  attach(GL_VERTEX_SHADER, text.vertex);
  // Without a fragment shader, compatibility profiles add their fixed function, and what Mesa links then
  // captures nothing.
  if (problem.empty())
    attach(GL_FRAGMENT_SHADER,
           text.fragment.empty() ? std::vector<std::string>{"void main() {}\n"} : text.fragment);
  if (!problem.empty()) return {StatusCode::no_device, problem};
  if (!text.feedback.empty())
    gl.TransformFeedbackVaryings(program.name(), static_cast<GLsizei>(text.feedback.size()),
                                 text.feedback.data(), GL_INTERLEAVED_ATTRIBS);
  gl.LinkProgram(program.name());
  GLint ok = GL_FALSE;
  gl.GetProgramiv(program.name(), GL_LINK_STATUS, &ok);
  if (!ok) {
    char log[2048] = "";
    gl.GetProgramInfoLog(program.name(), sizeof log, nullptr, log);
    return {StatusCode::no_device,
            "program " + text.vertex.back().substr(0, text.vertex.back().find('\n')) + ": " + log};
  }
  gl.UseProgram(program.name());
  for (const auto& [name, unit] : text.units) gl.Uniform1i(program.uniform(name), unit);
  return program;
}

void TexelBuffer::assign(const void* data, std::size_t bytes, GLenum usage) {
  bytes_ = bytes;
  gl_->BindBuffer(GL_ARRAY_BUFFER, buffer_.name());  // a binding that every host can be asked for
  static const char kNothing[64] = {};
  gl_->BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(std::max<std::size_t>(bytes, sizeof kNothing)),
                  bytes >= sizeof kNothing || !data ? data : nullptr, usage);
  if (bytes < sizeof kNothing && data && bytes > 0)
    gl_->BufferSubData(GL_ARRAY_BUFFER, 0, static_cast<GLsizeiptr>(bytes), data);
  gl_->ActiveTexture(GL_TEXTURE0 + kScratchUnit);
  gl_->BindTexture(GL_TEXTURE_BUFFER, texture_.name());
  gl_->TexBuffer(GL_TEXTURE_BUFFER, format_, buffer_.name());
}

void TexelBuffer::reserve(std::size_t bytes, GLenum usage) {
  if (bytes > bytes_ || bytes_ == 0) assign(nullptr, std::max(bytes, bytes_ + bytes_ / 2), usage);
}

void TexelBuffer::write(std::size_t offset, const void* data, std::size_t bytes) {
  if (bytes == 0) return;
  gl_->BindBuffer(GL_ARRAY_BUFFER, buffer_.name());
  gl_->BufferSubData(GL_ARRAY_BUFFER, static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes), data);
}

void TexelBuffer::bind(int unit) const {
  gl_->ActiveTexture(static_cast<GLenum>(GL_TEXTURE0 + unit));
  gl_->BindTexture(GL_TEXTURE_BUFFER, texture_.name());
}

}  // namespace dupin

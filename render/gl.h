// OpenGL 3.3 core as a table of functions, loaded for one context: nothing global, so hosts and several
// contexts can coexist.
#ifndef DUPIN_RENDER_GL_H
#define DUPIN_RENDER_GL_H

#include <GL/glcorearb.h>

#include "../core/status.h"
#include "context.h"

namespace dupin {

// Every function used, as X(part of the pointer type's name, name).
// clang-format off
#define DUPIN_GL_FUNCTIONS(X)                                                                               \
  X(ACTIVETEXTURE, ActiveTexture) X(ATTACHSHADER, AttachShader)                                             \
  X(BEGINTRANSFORMFEEDBACK, BeginTransformFeedback) X(BINDBUFFER, BindBuffer)                               \
  X(BINDBUFFERBASE, BindBufferBase) X(BINDBUFFERRANGE, BindBufferRange)                                     \
  X(BINDFRAMEBUFFER, BindFramebuffer) X(BINDSAMPLER, BindSampler) X(BINDTEXTURE, BindTexture)               \
  X(BINDVERTEXARRAY, BindVertexArray) X(BLENDEQUATIONSEPARATE, BlendEquationSeparate)                       \
  X(BLENDFUNCSEPARATE, BlendFuncSeparate) X(BUFFERDATA, BufferData) X(BUFFERSUBDATA, BufferSubData)         \
  X(CHECKFRAMEBUFFERSTATUS, CheckFramebufferStatus) X(CLEARBUFFERFV, ClearBufferfv)                         \
  X(CLEARBUFFERUIV, ClearBufferuiv) X(COLORMASK, ColorMask) X(COLORMASKI, ColorMaski)                       \
  X(CLAMPCOLOR, ClampColor) X(COMPILESHADER, CompileShader) X(CREATEPROGRAM, CreateProgram) X(CREATESHADER, CreateShader)             \
  X(CULLFACE, CullFace) X(DELETEBUFFERS, DeleteBuffers) X(DELETEFRAMEBUFFERS, DeleteFramebuffers)           \
  X(DELETEPROGRAM, DeleteProgram) X(DELETESHADER, DeleteShader) X(DELETETEXTURES, DeleteTextures)           \
  X(DELETEVERTEXARRAYS, DeleteVertexArrays) X(DEPTHFUNC, DepthFunc) X(DEPTHMASK, DepthMask)                 \
  X(DEPTHRANGE, DepthRange) X(DISABLE, Disable) X(DISABLEI, Disablei) X(DRAWARRAYS, DrawArrays)             \
  X(DRAWBUFFERS, DrawBuffers) X(DRAWELEMENTS, DrawElements) X(DRAWELEMENTSBASEVERTEX, DrawElementsBaseVertex) X(ENABLE, Enable) X(ENABLEI, Enablei)           \
  X(ENABLEVERTEXATTRIBARRAY, EnableVertexAttribArray) X(ENDTRANSFORMFEEDBACK, EndTransformFeedback)         \
  X(FINISH, Finish) X(FRAMEBUFFERTEXTURE2D, FramebufferTexture2D) X(FRONTFACE, FrontFace)                   \
  X(GENBUFFERS, GenBuffers) X(GENFRAMEBUFFERS, GenFramebuffers) X(GENTEXTURES, GenTextures)                 \
  X(GENVERTEXARRAYS, GenVertexArrays) X(GETBOOLEANI_V, GetBooleani_v) X(GETBOOLEANV, GetBooleanv)           \
  X(GETDOUBLEV, GetDoublev) X(GETERROR, GetError) X(GETFLOATV, GetFloatv)                                   \
  X(GETFRAMEBUFFERATTACHMENTPARAMETERIV, GetFramebufferAttachmentParameteriv)                               \
  X(GETINTEGER64I_V, GetInteger64i_v) X(GETINTEGERI_V, GetIntegeri_v) X(GETINTEGERV, GetIntegerv)           \
  X(GETPROGRAMINFOLOG, GetProgramInfoLog) X(GETPROGRAMIV, GetProgramiv)                                     \
  X(GETSHADERINFOLOG, GetShaderInfoLog) X(GETSHADERIV, GetShaderiv) X(GETSTRING, GetString)                 \
  X(GETSTRINGI, GetStringi) X(GETTEXPARAMETERIV, GetTexParameteriv)                                         \
  X(GETUNIFORMLOCATION, GetUniformLocation) X(ISENABLED, IsEnabled) X(ISENABLEDI, IsEnabledi)               \
  X(LINKPROGRAM, LinkProgram) X(PIXELSTOREI, PixelStorei) X(POLYGONMODE, PolygonMode)                       \
  X(READBUFFER, ReadBuffer) X(READPIXELS, ReadPixels) X(SCISSOR, Scissor) X(SHADERSOURCE, ShaderSource)     \
  X(STENCILMASK, StencilMask) X(TEXBUFFER, TexBuffer) X(TEXIMAGE2D, TexImage2D) X(TEXIMAGE3D, TexImage3D)   \
  X(TEXPARAMETERI, TexParameteri) X(TEXSUBIMAGE2D, TexSubImage2D)                                           \
  X(TRANSFORMFEEDBACKVARYINGS, TransformFeedbackVaryings)                                                   \
  X(UNIFORM1F, Uniform1f) X(UNIFORM1I, Uniform1i) X(UNIFORM1UI, Uniform1ui) X(UNIFORM2F, Uniform2f)         \
  X(UNIFORM3I, Uniform3i) X(UNIFORM3F, Uniform3f) X(UNIFORM4F, Uniform4f)                                   \
  X(UNIFORMMATRIX3FV, UniformMatrix3fv) X(USEPROGRAM, UseProgram)                                           \
  X(VERTEXATTRIBIPOINTER, VertexAttribIPointer) X(VERTEXATTRIBPOINTER, VertexAttribPointer)                 \
  X(VIEWPORT, Viewport)
// clang-format on

struct Gl {
#define DUPIN_GL_MEMBER(type, name) PFNGL##type##PROC name = nullptr;
  DUPIN_GL_FUNCTIONS(DUPIN_GL_MEMBER)
#undef DUPIN_GL_MEMBER
  /// Clip space [0,1] in depth, for a reversed depth buffer; null before OpenGL 4.5 without ARB_clip_control.
  PFNGLCLIPCONTROLPROC ClipControl = nullptr;
  // State that later versions keep by draw buffer (4.0) and by viewport (4.1), and earlier functions set for
  // all of them; null before.
  PFNGLBLENDFUNCSEPARATEIPROC BlendFuncSeparatei = nullptr;
  PFNGLBLENDEQUATIONSEPARATEIPROC BlendEquationSeparatei = nullptr;
  PFNGLVIEWPORTINDEXEDFPROC ViewportIndexedf = nullptr;
  PFNGLSCISSORINDEXEDPROC ScissorIndexed = nullptr;
  PFNGLDEPTHRANGEINDEXEDPROC DepthRangeIndexed = nullptr;
  PFNGLGETFLOATI_VPROC GetFloati_v = nullptr;
  PFNGLGETDOUBLEI_VPROC GetDoublei_v = nullptr;
  /// Compatibility contexts alone.
  void(APIENTRYP PixelTransferf)(GLenum name, GLfloat value) = nullptr;
  bool compatibility() const {
    return PixelTransferf != nullptr;
  }
};

/// The table of the current context; fails with no_device if it is older than 3.3 or a function is missing.
Result<Gl> load_gl(const GetProcAddress& get_proc_address);

}  // namespace dupin

#endif

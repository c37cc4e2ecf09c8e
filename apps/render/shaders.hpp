// The GLSL of the renderer's three passes.
#pragma once

namespace crumble::render {

extern const char* const kShadowVertex;
extern const char* const kShadowFragment;
extern const char* const kSurfaceVertex;
extern const char* const kSurfaceFragment;
extern const char* const kCompositeVertex;
extern const char* const kCompositeFragment;

}  // namespace crumble::render

// Light is linear until the tone curve at the end of the last pass; lengths are metres. Tofu is a wet, translucent gel:
// light creeps past the terminator (wrapped diffuse term, warmer where it has travelled further) and its broken faces
// are rough curd, so their normals are bent by noise that is fixed in rest coordinates and moves with the material.
#include "render/shaders.hpp"

namespace crumble::render {

const char* const kShadowVertex = R"(#version 330 core
layout(location = 0) in vec3 position;
uniform mat4 to_light_clip;
void main() { gl_Position = to_light_clip * vec4(position, 1.0); }
)";

const char* const kShadowFragment = R"(#version 330 core
void main() {}
)";

const char* const kSurfaceVertex = R"(#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 rest_position;
layout(location = 3) in float material;
uniform mat4 view, projection;
out vec3 world_point, world_normal, rest_point;
flat out int kind;
void main() {
  world_point = position;
  world_normal = normal;
  rest_point = rest_position;
  kind = int(material + 0.5);
  gl_Position = projection * (view * vec4(position, 1.0));
}
)";

const char* const kSurfaceFragment = R"(#version 330 core
in vec3 world_point, world_normal, rest_point;
flat in int kind;
layout(location = 0) out vec4 key_light;      // rgb, how much of the pixel is covered
layout(location = 1) out vec4 ambient_light;  // rgb
layout(location = 2) out vec4 eye_normal;     // xyz, 1 for tofu
uniform mat4 view, to_light_clip;
uniform vec3 eye, to_light, floor_center;
uniform float light_radius;   // of the sphere that the shadow map covers
uniform float floor_fade;     // radius at which the floor has become background
uniform sampler2D shadow_depth;
uniform sampler2DShadow shadow_test;

const int kSkin = 0, kInterior = 1, kWood = 2, kSteel = 3, kFloor = 4;
const vec3 kKeyColour = vec3(1.0, 0.95, 0.87) * 2.65;
const vec3 kSkyColour = vec3(0.58, 0.64, 0.74);
const vec3 kGroundColour = vec3(0.30, 0.27, 0.24);

float lattice_value(ivec3 p) {
  uint h = uint(p.x) * 0x9e3779b1u ^ uint(p.y) * 0x85ebca77u ^ uint(p.z) * 0xc2b2ae3du;
  h = (h ^ (h >> 15)) * 0x2c1b3c6du;
  h = (h ^ (h >> 12)) * 0x297a2d39u;
  return float((h ^ (h >> 15)) & 0xffffu) / 65535.0;
}

// Value noise in [0, 1] with its gradient: (value, d/dx, d/dy, d/dz).
vec4 noise(vec3 p) {
  ivec3 i = ivec3(floor(p));
  vec3 f = p - vec3(i);
  vec3 u = f * f * f * (f * (f * 6.0 - 15.0) + 10.0), du = 30.0 * f * f * (f * (f - 2.0) + 1.0);
  float a = lattice_value(i), b = lattice_value(i + ivec3(1, 0, 0)), c = lattice_value(i + ivec3(0, 1, 0));
  float d = lattice_value(i + ivec3(1, 1, 0)), e = lattice_value(i + ivec3(0, 0, 1));
  float g = lattice_value(i + ivec3(1, 0, 1)), h = lattice_value(i + ivec3(0, 1, 1));
  float j = lattice_value(i + ivec3(1, 1, 1));
  vec4 near = vec4(a, b - a, c - a, a - b - c + d), rise = vec4(e, g - e, h - e, e - g - h + j) - near;
  vec4 at = near + u.z * rise;
  float value = at.x + at.y * u.x + at.z * u.y + at.w * u.x * u.y;
  float along_z = rise.x + rise.y * u.x + rise.z * u.y + rise.w * u.x * u.y;
  return vec4(value, du * vec3(at.y + at.w * u.y, at.z + at.w * u.x, along_z));
}

// Noise of grain size `grain` metres; the gradient is per grain.
vec4 grain_noise(vec3 p, float grain) { return noise(p / grain + 37.0); }

vec3 bend(vec3 n, vec3 gradient, float amount) { return normalize(n - amount * (gradient - n * dot(gradient, n))); }

float dither_angle() { return 6.2831853 * fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715)))); }

vec2 spiral(int i, int count, float turn) {
  float angle = float(i) * 2.3999632 + turn;
  return sqrt((float(i) + 0.5) / float(count)) * vec2(cos(angle), sin(angle));
}

// Share of the key light that arrives: the further the blocker, the wider the penumbra.
float light_share(vec3 point, vec3 n) {
  float bias = 0.004 * light_radius;
  vec3 at = (to_light_clip * vec4(point + n * bias, 1.0)).xyz * 0.5 + 0.5;
  if (any(lessThan(at.xy, vec2(0.0))) || any(greaterThan(at.xy, vec2(1.0)))) return 1.0;
  at.z -= 0.0015;
  float tested = min(at.z, 0.9999);  // the floor goes on behind the map's far end, 1, which means: no blocker
  float turn = dither_angle(), blockers = 0.0, depth = 0.0;
  for (int i = 0; i < 10; ++i) {
    float d = texture(shadow_depth, at.xy + 0.03 * spiral(i, 10, turn)).r;
    if (d < tested) blockers += 1.0, depth += d;
  }
  if (blockers == 0.0) return 1.0;
  float width = clamp(0.16 * (at.z - depth / blockers), 0.0012, 0.03), share = 0.0;
  for (int i = 0; i < 14; ++i) share += texture(shadow_test, vec3(at.xy + width * spiral(i, 14, turn), tested));
  return share / 14.0;
}

float grid_line(vec2 p, float spacing) {
  vec2 to_line = abs(fract(p / spacing - 0.5) - 0.5) * spacing, pixel = fwidth(p);
  vec2 line = 1.0 - smoothstep(0.5 * pixel, 1.5 * pixel, to_line - 0.00006);
  return max(line.x, line.y);
}

struct Look {
  vec3 albedo, normal;
  float wrap, gloss, shine;  // share of light past the terminator, highlight strength and exponent
};

Look look_at(vec3 n) {
  if (kind == kSkin) {
    vec4 cloud = grain_noise(rest_point, 0.0045), fine = grain_noise(rest_point, 0.0006);
    vec3 albedo = vec3(0.84, 0.775, 0.62) * (0.96 + 0.06 * cloud.x) * (0.985 + 0.03 * fine.x);
    return Look(albedo, bend(n, cloud.yzw * 0.03 + fine.yzw * 0.035, 1.0), 0.28, 0.10, 36.0);
  }
  if (kind == kInterior) {
    vec4 lumps = grain_noise(rest_point, 0.0019), curd = grain_noise(rest_point, 0.0008);
    vec4 fine = grain_noise(rest_point, 0.0004);
    float height = 0.55 * lumps.x + 0.3 * curd.x + 0.15 * fine.x;
    vec3 albedo = mix(vec3(0.56, 0.39, 0.20), vec3(0.80, 0.66, 0.43), smoothstep(0.2, 0.7, height));
    return Look(albedo, bend(n, 0.22 * lumps.yzw + 0.20 * curd.yzw + 0.10 * fine.yzw, 1.0), 0.30, 0.06, 22.0);
  }
  if (kind == kWood) {
    vec4 warp = grain_noise(rest_point * vec3(1.0, 1.0, 0.15), 0.003);
    float ring = 0.5 + 0.5 * sin((rest_point.x + 0.002 * warp.x) * 7000.0 + 3.0 * warp.x);
    vec4 fibre = grain_noise(rest_point * vec3(1.0, 1.0, 0.03), 0.00025);
    vec3 albedo = mix(vec3(0.34, 0.165, 0.07), vec3(0.47, 0.25, 0.115), 0.5 * ring + 0.5 * fibre.x);
    return Look(albedo, n, 0.0, 0.22, 30.0);
  }
  if (kind == kSteel) return Look(vec3(0.30, 0.31, 0.33), n, 0.0, 1.1, 60.0);
  vec2 p = world_point.xz;
  return Look(vec3(0.085, 0.108, 0.125) * (1.0 + 0.22 * grid_line(p, 0.01)), n, 0.0, 0.04, 18.0);
}

void main() {
  vec3 n = world_normal / max(length(world_normal), 1e-9);  // zero on a facet without area
  Look look = look_at(n);
  vec3 m = look.normal, to_eye = normalize(eye - world_point), h = normalize(to_eye + to_light);
  bool is_tofu = kind == kSkin || kind == kInterior;
  float share = light_share(world_point, n), lambert = dot(m, to_light);
  float diffuse = max(0.0, (lambert + look.wrap) / (1.0 + look.wrap));
  vec3 creep = is_tofu ? mix(vec3(1.0, 0.86, 0.66), vec3(1.0), smoothstep(-0.1, 0.55, lambert)) : vec3(1.0);
  float highlight = look.gloss * pow(max(0.0, dot(m, h)), look.shine) * step(0.0, lambert);
  float rim = pow(1.0 - max(0.0, dot(m, to_eye)), 5.0);
  vec3 hemisphere = mix(kGroundColour, kSkyColour, 0.5 + 0.5 * m.y);
  vec3 mirror = mix(kGroundColour, kSkyColour * 1.6, smoothstep(-0.3, 0.6, reflect(-to_eye, m).y));
  // A weak light beside the eye lifts the cut faces that look at the viewer out of the shadow.
  vec3 fill = vec3(0.30, 0.29, 0.28) * max(0.0, dot(m, to_eye));
  key_light = vec4(kKeyColour * share * (look.albedo * creep * diffuse + vec3(highlight)), 1.0);
  vec3 through = is_tofu ? vec3(1.18, 1.03, 0.86) : vec3(1.0);  // light that has been inside the tofu
  ambient_light = vec4(look.albedo * through * (hemisphere + fill) + mirror * look.gloss * (kind == kSteel ? 0.35 : rim), 1.0);
  eye_normal = vec4(mat3(view) * n, is_tofu ? 1.0 : 0.0);
  if (kind == kFloor) key_light.a = 1.0 - smoothstep(0.35, 1.0, distance(world_point, floor_center) / floor_fade);
}
)";

const char* const kCompositeVertex = R"(#version 330 core
void main() {
  vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  gl_Position = vec4(corner, 0.0, 1.0);
}
)";

const char* const kCompositeFragment = R"(#version 330 core
uniform sampler2D key_light, ambient_light, eye_normal, depth;
uniform float half_width, half_height;  // of the picture plane at distance 1
uniform float near, far, cavity_radius;
uniform int samples;          // per axis and output pixel
out vec4 colour;

vec3 eye_point(ivec2 texel) {
  vec2 size = vec2(textureSize(depth, 0));
  float d = 2.0 * texelFetch(depth, texel, 0).r - 1.0;
  float z = 2.0 * near * far / (far + near - d * (far - near));
  return z * vec3((2.0 * (vec2(texel) + 0.5) / size - 1.0) * vec2(half_width, half_height), -1.0);
}

// Ambient obscurance after McGuire, Mara and Luebke, "Scalable Ambient Obscurance" (2012), on every sample of the pixel.
float open_share(ivec2 texel, vec3 n) {
  const int kCount = 14;
  ivec2 size = textureSize(depth, 0);
  vec3 p = eye_point(texel);
  float reach = cavity_radius * float(size.y) / (2.0 * half_height * -p.z), r2 = cavity_radius * cavity_radius;
  float turn = 6.2831853 * fract(52.9829189 * fract(dot(vec2(texel), vec2(0.06711056, 0.00583715)))), sum = 0.0;
  for (int i = 0; i < kCount; ++i) {
    float share = (float(i) + 0.5) / float(kCount), angle = float(i) * 2.3999632 + turn;
    ivec2 at = texel + ivec2(share * reach * vec2(cos(angle), sin(angle)));
    vec3 v = eye_point(clamp(at, ivec2(0), size - 1)) - p;
    float vv = dot(v, v), fall = max(0.0, 1.0 - vv / r2);
    sum += fall * fall * max(0.0, dot(v, n) - 0.02 * cavity_radius) / (sqrt(vv) + 0.05 * cavity_radius);
  }
  return clamp(1.0 - 2.4 * sum / float(kCount), 0.0, 1.0);
}

vec3 tone(vec3 light) {
  vec3 x = 0.60 * light;
  x = x * (1.0 + x * 0.10) / (1.0 + x);
  return pow(clamp(1.42 * x, 0.0, 1.0), vec3(1.0 / 2.2));
}

void main() {
  ivec2 first = ivec2(gl_FragCoord.xy) * samples;
  float height = gl_FragCoord.y * float(samples) / float(textureSize(depth, 0).y);
  vec3 background = mix(vec3(0.10, 0.125, 0.145), vec3(0.42, 0.47, 0.51), smoothstep(0.25, 1.1, height));
  vec3 sum = vec3(0.0);
  for (int y = 0; y < samples; ++y) {
    for (int x = 0; x < samples; ++x) {
      ivec2 texel = first + ivec2(x, y);
      vec4 key = texelFetch(key_light, texel, 0);
      vec3 light = background;
      if (key.a > 0.0) {
        vec4 normal = texelFetch(eye_normal, texel, 0);
        float open = open_share(texel, normal.xyz);
        // Light that reaches a cavity in tofu has been through tofu: it is warm.
        vec3 ambient_open = normal.a > 0.5 ? pow(vec3(open), vec3(1.0, 1.15, 1.4)) : vec3(open);
        vec3 lit = key.rgb * mix(0.45, 1.0, open) + texelFetch(ambient_light, texel, 0).rgb * ambient_open;
        light = mix(background, lit, key.a);
      }
      sum += tone(light);
    }
  }
  colour = vec4(sum / float(samples * samples), 1.0);
}
)";

}  // namespace crumble::render

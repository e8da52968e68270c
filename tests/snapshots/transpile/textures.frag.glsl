#version 330 core
// textures
// Made by sssgen for GLSL 3.30 (OpenGL 3.3 core). Change the source and emit it again rather than this file.

uniform sampler2D map;
uniform samplerCube sky;
uniform sampler3D fog;
uniform sampler2DArray layers;
uniform isampler2D numbers;

in vec3 place;
out vec4 color;

vec4 textureGatherOffset_(sampler2D map, vec2 P, ivec2 offset) {
    vec2 size = vec2(textureSize(map, 0));
    vec2 low = (floor(P * size - 0.5) + vec2(offset) + 0.5) / size;
    vec2 high = low + 1.0 / size;
    return vec4(textureLod(map, vec2(low.x, high.y), 0.0).r, textureLod(map, high, 0.0).r,
        textureLod(map, vec2(high.x, low.y), 0.0).r, textureLod(map, low, 0.0).r);
}

vec4 from(sampler2D source, vec2 uv) {
    return texture(source, uv);
}

vec3 blurred(sampler2D source, vec2 uv, float radius) {
    vec2 texel = 1.0 / vec2(textureSize(source, 0));
    vec3 sum = vec3(0.0);
    for (int y = -1; y <= 1; y++) {
        for (int x = -1; x <= 1; x++) {
            sum += textureLod(source, uv + vec2(float(x), float(y)) * texel * radius, 0.0).rgb;
        }
    }
    return sum / 9.0;
}

void main() {
    vec2 uv = place.xy;
    vec2 dx = dFdx(uv);
    vec2 dy = dFdy(uv);
    vec4 sum = texture(map, uv) + texture(map, uv, 0.5) + texture(sky, place) + texture(fog, place);
    sum += texture(layers, vec3(uv, 1.0));
    sum += textureLod(map, uv, 1.0) + textureLod(sky, place, 2.0) + textureGrad(map, uv, dx, dy);
    sum += textureOffset(map, uv, ivec2(1, -1)) + textureLodOffset(map, uv, 0.0, ivec2(0, 2));
    vec3 place_ = vec3(uv, 2.0);
    vec4 place_2 = vec4(uv, 0.0, 2.0);
    sum += texture(map, place_.xy / place_.z) + texture(map, place_2.xy / place_2.w);
    sum += texelFetch(map, ivec2(gl_FragCoord.xy), 0) + texelFetchOffset(map, ivec2(uv), 0, ivec2(1));
    sum += vec4(texelFetch(numbers, ivec2(3, 4), 0)) + textureGatherOffset_(map, uv, ivec2(0));
    sum.xy += vec2(textureSize(sky, 0)) + vec2(textureSize(fog, 1).xy);
    sum += from(map, uv * 2.0);
    sum.rgb += blurred(map, uv, 2.0);
    color = sum;
}

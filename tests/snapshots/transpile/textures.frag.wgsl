// textures
// Made by sssgen for WGSL (WebGPU). Change the source and emit it again rather than this file.

@group(1) @binding(1) var map: texture_2d<f32>;
@group(1) @binding(2) var map_sampler: sampler;
@group(1) @binding(3) var sky: texture_cube<f32>;
@group(1) @binding(4) var sky_sampler: sampler;
@group(1) @binding(5) var fog: texture_3d<f32>;
@group(1) @binding(6) var fog_sampler: sampler;
@group(1) @binding(7) var layers: texture_2d_array<f32>;
@group(1) @binding(8) var layers_sampler: sampler;
@group(1) @binding(9) var numbers: texture_2d<i32>;
@group(1) @binding(10) var numbers_sampler: sampler;

var<private> place: vec3f;
var<private> color: vec4f;
var<private> FragCoord: vec4f;

fn texture(map: texture_2d_array<f32>, map_sampler: sampler, P: vec3f) -> vec4f {
    return textureSample(map, map_sampler, P.xy, i32(round(P.z)));
}

fn from_(source: texture_2d<f32>, source_sampler: sampler, uv: vec2f) -> vec4f {
    return textureSample(source, source_sampler, uv);
}

fn blurred(source: texture_2d<f32>, source_sampler: sampler, uv: vec2f, radius: f32) -> vec3f {
    let texel = 1.0 / vec2f(vec2i(textureDimensions(source, 0)));
    var sum = vec3f(0.0);
    for (var y = -1; y <= 1; y++) {
        for (var x = -1; x <= 1; x++) {
            sum += textureSampleLevel(source, source_sampler, uv + vec2f(f32(x), f32(y)) * texel * radius,
                0.0).rgb;
        }
    }
    return sum / 9.0;
}

fn main_() {
    let uv = place.xy;
    let dx = dpdx(uv);
    let dy = -dpdy(uv);
    var sum = textureSample(map, map_sampler, uv) + textureSampleBias(map, map_sampler, uv, 0.5)
        + textureSample(sky, sky_sampler, place) + textureSample(fog, fog_sampler, place);
    sum += texture(layers, layers_sampler, vec3f(uv, 1.0));
    sum += textureSampleLevel(map, map_sampler, uv, 1.0) + textureSampleLevel(sky, sky_sampler, place, 2.0)
        + textureSampleGrad(map, map_sampler, uv, dx, dy);
    sum += textureSample(map, map_sampler, uv, vec2i(1, -1))
        + textureSampleLevel(map, map_sampler, uv, 0.0, vec2i(0, 2));
    let place_ = vec3f(uv, 2.0);
    let place_2 = vec4f(uv, 0.0, 2.0);
    sum += textureSample(map, map_sampler, place_.xy / place_.z)
        + textureSample(map, map_sampler, place_2.xy / place_2.w);
    sum += textureLoad(map, vec2i(FragCoord.xy), 0) + textureLoad(map, vec2i(uv) + vec2i(1), 0);
    sum += vec4f(textureLoad(numbers, vec2i(3, 4), 0)) + textureGather(0, map, map_sampler, uv);
    let sum_xy = sum.xy
        + (vec2f(vec2i(textureDimensions(sky, 0))) + vec2f(vec3i(textureDimensions(fog, 1)).xy));
    sum = vec4f(sum_xy, sum.zw);
    sum += from_(map, map_sampler, uv * 2.0);
    let sum_xyz = sum.rgb + blurred(map, map_sampler, uv, 2.0);
    sum = vec4f(sum_xyz, sum.w);
    color = sum;
}

@fragment
fn fragment_main(@location(0) place_in: vec3f, @builtin(position) FragCoord_in: vec4f) -> @location(0) vec4f {
    place = place_in;
    FragCoord = FragCoord_in;
    main_();
    return color;
}

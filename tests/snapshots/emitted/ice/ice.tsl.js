// Ice: Cracked ice in facets: back light, moving veins below the surface, a cover of snow, and holes
// that melt into it.
// Made by sssgen for TSL (three.js). Change the material and emit it again rather than this file.

import { Fn, If, Loop, clamp, dot, exp, float, floor, fract, int, inverseSqrt, length, max, min, mix,
    normalize, pow, select, smoothstep, struct, uint, vec2, vec3 } from 'three/tsl';

export const Cell = /*@__PURE__*/ struct({ nearest: 'vec2', second: 'vec2', level: 'float' }, 'Cell');

export const Surface = /*@__PURE__*/ struct({ albedo: 'vec3', alpha: 'float', normal: 'vec3',
    metallic: 'float', roughness: 'float', emission: 'vec3', transmittance: 'float' }, 'Surface');

export const Base_colorResult = /*@__PURE__*/ struct({ albedo: 'vec3', alpha: 'float' }, 'Base_colorResult');

export const Pbr_constantsResult = /*@__PURE__*/ struct({ metallic: 'float', roughness: 'float' },
    'Pbr_constantsResult');

export const Alpha_erosionResult = /*@__PURE__*/ struct({ alpha: 'float', normal: 'vec3' },
    'Alpha_erosionResult');

const JITTER = /*@__PURE__*/ float(0.6);
const OPAQUE_DISTANCE = /*@__PURE__*/ float(1.0e-6);
const ENDLESS = /*@__PURE__*/ float(10000.0);
const OPAQUE_DEPTH = /*@__PURE__*/ float(80.0);

// The direction of `x`; of a zero vector, 0.
export const safe_normalize_vec2 = /*@__PURE__*/ Fn(([x]) => {
    return x.mul(select(dot(x, x).greaterThan(1.0e-30), inverseSqrt(dot(x, x)), 0.0));
}).setLayout({ name: 'safe_normalize_vec2', type: 'vec2', inputs: [{ name: 'x', type: 'vec2' }] });

// The direction of `x`; of a zero vector, 0.
export const safe_normalize_vec3 = /*@__PURE__*/ Fn(([x]) => {
    return x.mul(select(dot(x, x).greaterThan(1.0e-30), inverseSqrt(dot(x, x)), 0.0));
}).setLayout({ name: 'safe_normalize_vec3', type: 'vec3', inputs: [{ name: 'x', type: 'vec3' }] });

// Scrambles the bits of `x`; 0 stays 0.
export const hash_bits = /*@__PURE__*/ Fn(([x_in]) => {
    const x = x_in.toVar();
    x.assign(x.bitXor(x.shiftRight(uint(16))).mul(uint(0x7feb352d)));
    x.assign(x.bitXor(x.shiftRight(uint(15))).mul(uint(0x846ca68b)));
    return x.bitXor(x.shiftRight(uint(16)));
}).setLayout({ name: 'hash_bits', type: 'uint', inputs: [{ name: 'x_in', type: 'uint' }] });

// A number in [0, 1) from 24 bits of the hash of `x`.
export const hash_unit = /*@__PURE__*/ Fn(([x]) => {
    return float(hash_bits(x).shiftRight(uint(8))).mul(5.9604645e-8);
}).setLayout({ name: 'hash_unit', type: 'float', inputs: [{ name: 'x', type: 'uint' }] });

// The cell at `p`.
export const cell_at = /*@__PURE__*/ Fn(([p, variation]) => {
    const nearest = vec2(4.0).toVar();
    const second = vec2(4.0).toVar();
    // their squared lengths
    const first_square = float(32.0).toVar();
    const second_square = float(32.0).toVar();
    const owner = uint(0).toVar();
    // relative to the cell's corner, so that precision does not depend on the distance from the origin
    const home = floor(p).toConst();
    const within = p.sub(home).toConst();
    Loop({ start: -1, end: 1, type: 'int', condition: '<=', name: 'j' }, ({ j }) => {
        Loop({ start: -1, end: 1, type: 'int', condition: '<=', name: 'i' }, ({ i }) => {
            const offset = vec2(float(i), float(j)).toConst();
            const corner = home.add(offset).toConst();
            const seed = hash_bits(uint(int(corner.x)).add(hash_bits(uint(int(corner.y)).add(uint(1)))))
                .toConst();
            const shift = vec2(hash_unit(seed.add(uint(1))), hash_unit(seed.add(uint(2)))).sub(0.5).toConst();
            const to_site = offset.add(0.5).add(JITTER.mul(shift)).sub(within).toConst();
            const square = dot(to_site, to_site).toConst();
            If(square.lessThan(first_square), () => {
                second.assign(nearest);
                second_square.assign(first_square);
                nearest.assign(to_site);
                first_square.assign(square);
                owner.assign(seed);
            }).ElseIf(square.lessThan(second_square), () => {
                second.assign(to_site);
                second_square.assign(square);
            });
        });
    });
    const level = float(1.0).sub(variation.mul(hash_unit(owner.add(uint(3))))).toConst();
    return Cell(nearest, second, level);
}).setLayout({ name: 'cell_at', type: 'Cell', inputs: [
    { name: 'p', type: 'vec2' },
    { name: 'variation', type: 'float' },
] });

// How much farther the second nearest site is than the nearest one: 0 on the edges.
export const to_edge = /*@__PURE__*/ Fn(([cell]) => {
    return length(cell.get('second')).sub(length(cell.get('nearest')));
}).setLayout({ name: 'to_edge', type: 'float', inputs: [{ name: 'cell', type: 'Cell' }] });

// Thickness in Voronoi cells: facets with thin edges between them, as in cracked ice.
export const voronoi_thickness = /*@__PURE__*/ Fn(([uv, variation, cell_count, thickness_factor, bevel]) => {
    const cell = cell_at(uv.mul(cell_count), variation).toConst();
    return thickness_factor.mul(cell.get('level')).mul(smoothstep(0.0, bevel, to_edge(cell)));
}).setLayout({ name: 'voronoi_thickness', type: 'float', inputs: [
    { name: 'uv', type: 'vec2' },
    { name: 'variation', type: 'float' },
    { name: 'cell_count', type: 'float' },
    { name: 'thickness_factor', type: 'float' },
    { name: 'bevel', type: 'float' },
] });

// The thickness `d` in mean free paths, 0 or more.
export const optical_depth = /*@__PURE__*/ Fn(([d, mean_free_path]) => {
    const path = max(mean_free_path, OPAQUE_DISTANCE).toConst();
    return clamp(d, 0.0, ENDLESS.mul(path)).div(path);
}).setLayout({ name: 'optical_depth', type: 'float', inputs: [
    { name: 'd', type: 'float' },
    { name: 'mean_free_path', type: 'float' },
] });

// Thickness to transmittance: the part of the light that absorption leaves.
export const beer_lambert = /*@__PURE__*/ Fn(([d, attenuation_distance]) => {
    return exp(min(optical_depth(d, attenuation_distance), OPAQUE_DEPTH).negate());
}).setLayout({ name: 'beer_lambert', type: 'float', inputs: [
    { name: 'd', type: 'float' },
    { name: 'attenuation_distance', type: 'float' },
] });

// Colour and opacity from a texture and a tint.
export const base_color = /*@__PURE__*/ Fn(([uv, tint, base_color_texture]) => {
    const albedo = vec3().toVar();
    const alpha = float().toVar();
    const texel = tint.mul(base_color_texture.sample(uv)).toConst();
    albedo.assign(texel.xyz);
    alpha.assign(texel.w);
    return Base_colorResult(albedo, alpha);
});

// The same metalness and roughness everywhere.
export const pbr_constants = /*@__PURE__*/ Fn(([metalness, surface_roughness]) => {
    const metallic = float().toVar();
    const roughness = float().toVar();
    metallic.assign(metalness);
    roughness.assign(surface_roughness);
    return Pbr_constantsResult(metallic, roughness);
}).setLayout({ name: 'pbr_constants', type: 'Pbr_constantsResult', inputs: [
    { name: 'metalness', type: 'float' },
    { name: 'surface_roughness', type: 'float' },
] });

// The gradient of to_edge.
export const from_edge = /*@__PURE__*/ Fn(([cell]) => {
    // the nearest site may be exactly here, the second one cannot: they are at least 0.4 apart
    return safe_normalize_vec2(cell.get('nearest')).sub(normalize(cell.get('second')));
}).setLayout({ name: 'from_edge', type: 'vec2', inputs: [{ name: 'cell', type: 'Cell' }] });

// Adds `detail` to `base`: x and y are added, z is multiplied; for small slopes this adds the slopes.
export const blend_normals = /*@__PURE__*/ Fn(([base, detail]) => {
    return safe_normalize_vec3(vec3(base.xy.add(detail.xy), base.z.mul(detail.z)));
}).setLayout({ name: 'blend_normals', type: 'vec3', inputs: [
    { name: 'base', type: 'vec3' },
    { name: 'detail', type: 'vec3' },
] });

// The normal of a height field; `slope` is the increase in height per unit of length along T and B.
export const normal_of_slope = /*@__PURE__*/ Fn(([slope]) => {
    return normalize(vec3(slope.negate(), 1.0));
}).setLayout({ name: 'normal_of_slope', type: 'vec3', inputs: [{ name: 'slope', type: 'vec2' }] });

// The normal of the Voronoi cells, so that reflected light agrees with transmitted light.
export const voronoi_normal = /*@__PURE__*/ Fn(([uv, normal_in, variation, cell_count, bevel, relief,
    uv_per_unit]) => {
    const normal = normal_in.toVar();
    const cell = cell_at(uv.mul(cell_count), variation).toConst();
    const x = clamp(to_edge(cell).div(bevel), 0.0, 1.0).toConst();
    // the derivative of the smoothstep
    const steepness = cell.get('level').mul(6.0).mul(x).mul(float(1.0).sub(x)).div(bevel).toConst();
    const slope = relief.mul(uv_per_unit).mul(cell_count).mul(steepness).mul(from_edge(cell)).toConst();
    normal.assign(blend_normals(normal, normal_of_slope(slope)));
    return normal;
}).setLayout({ name: 'voronoi_normal', type: 'vec3', inputs: [
    { name: 'uv', type: 'vec2' },
    { name: 'normal_in', type: 'vec3' },
    { name: 'variation', type: 'float' },
    { name: 'cell_count', type: 'float' },
    { name: 'bevel', type: 'float' },
    { name: 'relief', type: 'float' },
    { name: 'uv_per_unit', type: 'vec2' },
] });

// Only the bare ice transmits light.
export const ice_mask = /*@__PURE__*/ Fn(([uv, through_in, cover, cover_texture]) => {
    const through = through_in.toVar();
    const covered = cover.mul(cover_texture.sample(uv).r).toConst();
    through.assign(through.mul(smoothstep(0.0, 0.1, float(1.0).sub(covered))));
    return through;
});

// One moving layer; the offset stays below 1, so that precision does not decrease with time.
export const layer = /*@__PURE__*/ Fn(([uv, speed, time, packed_texture]) => {
    return packed_texture.sample(uv.add(fract(speed.mul(time))));
});

// Moving light below the surface, from the channels of one texture, each of which scrolls separately.
export const packed_scroll = /*@__PURE__*/ Fn(([uv, time, emission_in, packed_texture, red_speed,
    green_speed, blue_speed, vein_color, spark_color]) => {
    const emission = emission_in.toVar();
    const veins = layer(uv, red_speed, time, packed_texture)
        .x.mul(layer(uv, green_speed, time, packed_texture).y).toConst();
    const sparks = layer(uv, blue_speed, time, packed_texture).z.toConst();
    emission.assign(min(emission.add(vein_color.mul(veins).add(spark_color.mul(sparks))), 65504.0));
    return emission;
});

// The part of the surface that remains at `uv`: 1 = all, 0 = none.
export const left_at = /*@__PURE__*/ Fn(([uv, edge, erosion, erosion_texture]) => {
    // the threshold goes from below black to white, so that erosion 0 keeps and erosion 1 removes everything
    const threshold = mix(edge.negate(), 1.0, erosion).toConst();
    return clamp(erosion_texture.sample(uv).r.sub(threshold).div(edge), 0.0, 1.0);
});

// Erodes the surface, dark parts of a mask first, with a bevelled normal at the edge.
export const alpha_erosion = /*@__PURE__*/ Fn(([uv, alpha_in, normal_in, uv_per_unit, texel_size, edge,
    erosion, erosion_texture, edge_height]) => {
    const alpha = alpha_in.toVar();
    const normal = normal_in.toVar();
    const e = vec2(texel_size, 0.0).toConst();
    const across = left_at(uv.add(e), edge, erosion, erosion_texture)
        .sub(left_at(uv.sub(e), edge, erosion, erosion_texture)).toConst();
    const up = left_at(uv.add(e.yx), edge, erosion, erosion_texture)
        .sub(left_at(uv.sub(e.yx), edge, erosion, erosion_texture)).toConst();
    const slope = edge_height.mul(uv_per_unit).mul(vec2(across, up)).div(float(2.0).mul(texel_size))
        .toConst();
    normal.assign(blend_normals(normal, normal_of_slope(slope)));
    alpha.mulAssign(left_at(uv, edge, erosion, erosion_texture));
    return Alpha_erosionResult(alpha, normal);
});

// The transmitted light for a lobe value of 0..1 and a transmittance.
export const glow = /*@__PURE__*/ Fn(([lobe, through, subsurface_color, attenuation, scale, ambient]) => {
    return subsurface_color.mul(attenuation.mul(lobe.mul(scale).add(ambient)).mul(through));
}).setLayout({ name: 'glow', type: 'vec3', inputs: [
    { name: 'lobe', type: 'float' },
    { name: 'through', type: 'float' },
    { name: 'subsurface_color', type: 'vec3' },
    { name: 'attenuation', type: 'float' },
    { name: 'scale', type: 'float' },
    { name: 'ambient', type: 'float' },
] });

// The back-light lobe with a unit half vector: the lobe of Alisavakis and Unity ice, corrected.
export const lobe_normalized = /*@__PURE__*/ Fn(([V, N, L, through, distortion, subsurface_color,
    attenuation, scale, ambient, power]) => {
    const bent = safe_normalize_vec3(L.add(N.mul(distortion))).toConst();
    return glow(pow(clamp(dot(V, bent.negate()), 0.0, 1.0), power), through, subsurface_color, attenuation,
        scale, ambient);
}).setLayout({ name: 'lobe_normalized', type: 'vec3', inputs: [
    { name: 'V', type: 'vec3' },
    { name: 'N', type: 'vec3' },
    { name: 'L', type: 'vec3' },
    { name: 'through', type: 'float' },
    { name: 'distortion', type: 'float' },
    { name: 'subsurface_color', type: 'vec3' },
    { name: 'attenuation', type: 'float' },
    { name: 'scale', type: 'float' },
    { name: 'ambient', type: 'float' },
    { name: 'power', type: 'float' },
] });

// The values of the surface that do not depend on a light.
export const evaluate_surface = /*@__PURE__*/ Fn(([uv, time, variation, cell_count, thickness_factor, bevel,
    attenuation_distance, tint, base_color_texture, metalness, surface_roughness, relief, uv_per_unit, cover,
    cover_texture, packed_texture, red_speed, green_speed, blue_speed, vein_color, spark_color, texel_size,
    edge, erosion, erosion_texture, edge_height]) => {
    const thickness = voronoi_thickness(uv, variation, cell_count, thickness_factor, bevel).toConst();
    const transmittance = beer_lambert(thickness, attenuation_distance).toVar();
    const albedo = vec3().toVar();
    const alpha = float().toVar();
    const base_color_result = base_color(uv, tint, base_color_texture).toConst();
    albedo.assign(base_color_result.get('albedo'));
    alpha.assign(base_color_result.get('alpha'));
    const metallic = float().toVar();
    const roughness = float().toVar();
    const pbr_constants_result = pbr_constants(metalness, surface_roughness).toConst();
    metallic.assign(pbr_constants_result.get('metallic'));
    roughness.assign(pbr_constants_result.get('roughness'));
    const normal = vec3(0.0, 0.0, 1.0).toVar();
    normal.assign(voronoi_normal(uv, normal, variation, cell_count, bevel, relief, uv_per_unit));
    transmittance.assign(ice_mask(uv, transmittance, cover, cover_texture));
    const emission = vec3(0.0).toVar();
    emission.assign(packed_scroll(uv, time, emission, packed_texture, red_speed, green_speed, blue_speed,
        vein_color, spark_color));
    const alpha_erosion_result = alpha_erosion(uv, alpha, normal, uv_per_unit, texel_size, edge, erosion,
        erosion_texture, edge_height).toConst();
    alpha.assign(alpha_erosion_result.get('alpha'));
    normal.assign(alpha_erosion_result.get('normal'));
    return Surface(albedo, alpha, normal, metallic, roughness, emission, transmittance);
});

// The transmitted light of one light, as a factor on its colour.
export const evaluate_translucency = /*@__PURE__*/ Fn(([surface, V, N, L, distortion, subsurface_color,
    attenuation, scale, ambient, power]) => {
    return lobe_normalized(V, N, L, surface.get('transmittance'), distortion, subsurface_color, attenuation,
        scale, ambient, power);
}).setLayout({ name: 'evaluate_translucency', type: 'vec3', inputs: [
    { name: 'surface', type: 'Surface' },
    { name: 'V', type: 'vec3' },
    { name: 'N', type: 'vec3' },
    { name: 'L', type: 'vec3' },
    { name: 'distortion', type: 'float' },
    { name: 'subsurface_color', type: 'vec3' },
    { name: 'attenuation', type: 'float' },
    { name: 'scale', type: 'float' },
    { name: 'ambient', type: 'float' },
    { name: 'power', type: 'float' },
] });

// Ice: Cracked ice in facets: back light, moving veins below the surface, a cover of snow, and holes
// that melt into it.
// Made by sssgen for Unity, built-in pipeline (surface shader). Change the material and emit it again rather than this file.
Shader "sssgen/Ice" {
    Properties {
        [NoScaleOffset] _BaseColorTexture ("Base color texture", 2D) = "white" {}
        [NoScaleOffset] _CoverTexture ("Cover texture", 2D) = "black" {}
        [NoScaleOffset] _PackedTexture ("Packed texture", 2D) = "black" {}
        [NoScaleOffset] _ErosionTexture ("Erosion texture", 2D) = "white" {}
        _Variation ("Variation", Range(0, 1)) = 0.6
        _CellCount ("Cell count", Range(1, 200)) = 10
        _ThicknessFactor ("Thickness factor", Range(0, 10)) = 0.3
        _Bevel ("Bevel", Range(0.05, 1)) = 0.35
        _AttenuationDistance ("Attenuation distance", Range(0, 10)) = 0.25
        [HDR] _Tint ("Tint", Color) = (0.75, 0.9, 1, 1)
        _Metalness ("Metalness", Range(0, 1)) = 0
        _SurfaceRoughness ("Surface roughness", Range(0, 1)) = 0.12
        _Relief ("Relief", Range(0, 1)) = 0.01
        _UvPerUnit ("Uv per unit", Vector) = (1, 1, 0, 0)
        _Cover ("Cover", Range(0, 1)) = 1
        _RedSpeed ("Red speed", Vector) = (0.02, 0, 0, 0)
        _GreenSpeed ("Green speed", Vector) = (-0.01, 0.015, 0, 0)
        _BlueSpeed ("Blue speed", Vector) = (0, -0.025, 0, 0)
        [HDR] _VeinColor ("Vein color", Color) = (0.3, 0.8, 1, 1)
        [HDR] _SparkColor ("Spark color", Color) = (0.6, 0.9, 1, 1)
        _TexelSize ("Texel size", Range(0.0001, 0.1)) = 0.002
        _Edge ("Edge", Range(0.01, 1)) = 0.15
        _Erosion ("Erosion", Range(0, 1)) = 0.2
        _EdgeHeight ("Edge height", Range(0, 1)) = 0.02
        _Distortion ("Distortion", Range(0, 1)) = 0.2
        [HDR] _SubsurfaceColor ("Subsurface color", Color) = (0.55, 0.85, 1, 1)
        _Attenuation ("Attenuation", Range(0, 1)) = 0.8
        _Scale ("Scale", Range(0, 20)) = 2
        _Ambient ("Ambient", Range(0, 1)) = 0.12
        _Power ("Power", Range(1, 32)) = 6
    }
    SubShader {
        Tags { "RenderType" = "TransparentCutout" "Queue" = "AlphaTest" }

        CGPROGRAM
        // Forward only: a deferred pass has no room for translucency.
        #pragma surface surf Sss fullforwardshadows exclude_path:deferred exclude_path:prepass vertex:vert addshadow
        #pragma target 3.5
        #include "UnityPBSLighting.cginc"

        struct Cell {
            float2 nearest;
            float2 second;
            float level;
        };

        struct Surface {
            float3 albedo;
            float alpha;
            float3 normal;
            float metallic;
            float roughness;
            float3 emission;
            float transmittance;
        };

        static const float JITTER = 0.6;
        static const float OPAQUE_DISTANCE = 1.0e-6;
        static const float ENDLESS = 10000.0;
        static const float OPAQUE_DEPTH = 80.0;

        float _Variation;  // How much the levels of the cells differ: 0 = all are equal
        float _CellCount;  // Number of cells along one unit of texture coordinate
        float _ThicknessFactor;  // Thickness of a cell of level 1
        float _Bevel;  // Width of the slope next to an edge, in cells
        float _AttenuationDistance;  // The length after which 1/e (37 %) of the light remains; 0 = opaque
        float4 _Tint;  // Multiplies the texture
        float _Metalness;  // 0 = not a metal, 1 = metal
        float _SurfaceRoughness;  // 0 = smooth as a mirror, 1 = rough as chalk
        float _Relief;  // Height of the thickest cells above their edges
        float2 _UvPerUnit;  // Change of the texture coordinates per world unit along T and along B
        float _Cover;  // Multiplies the texture
        float2 _RedSpeed;  // Velocity of the red layer
        float2 _GreenSpeed;  // Velocity of the green layer
        float2 _BlueSpeed;  // Velocity of the blue layer
        float3 _VeinColor;  // Colour of the light in the red and green layers, where both are bright
        float3 _SparkColor;  // Colour of the light in the blue layer
        float _TexelSize;  // The length, in texture coordinates, over which slopes are measured: about one texel
        float _Edge;  // Width of the soft edge, in the texture's values
        float _Erosion;  // How much is eroded: 0 = nothing, 1 = everything
        float _EdgeHeight;  // Height of the step in the surface at the edge
        float _Distortion;  // How far the normal bends the light's direction inside the body: 0 ignores the shape
        float3 _SubsurfaceColor;  // Colour of the transmitted light
        float _Attenuation;  // Factor on the whole result
        float _Scale;  // Strength of the glow towards the light
        float _Ambient;  // Glow that does not depend on the direction
        float _Power;  // How narrow the glow around the light is: the larger, the smaller the spot

        sampler2D _BaseColorTexture;
        sampler2D _CoverTexture;
        sampler2D _PackedTexture;
        sampler2D _ErosionTexture;

        // Unity's first look at a surface shader understands no more than DX9's HLSL, and needs no bodies.
        #if defined(SHADER_TARGET_SURFACE_ANALYSIS_MOJOSHADER)
        Surface evaluate_surface(float2 uv, float time, float3 irradiance_behind);
        float3 evaluate_translucency(Surface surface, float3 V, float3 N, float3 L);
        #else
        // The direction of `x`; of a zero vector, 0.
        float2 safe_normalize(float2 x) {
            return x * (dot(x, x) > 1.0e-30 ? rsqrt(dot(x, x)) : 0.0);
        }

        // The direction of `x`; of a zero vector, 0.
        float3 safe_normalize(float3 x) {
            return x * (dot(x, x) > 1.0e-30 ? rsqrt(dot(x, x)) : 0.0);
        }

        // Scrambles the bits of `x`; 0 stays 0.
        uint hash_bits(uint x) {
            x = (x ^ (x >> 16u)) * 0x7feb352du;
            x = (x ^ (x >> 15u)) * 0x846ca68bu;
            return x ^ (x >> 16u);
        }

        // A number in [0, 1) from 24 bits of the hash of `x`.
        float hash_unit(uint x) {
            return float(hash_bits(x) >> 8u) * 5.9604645e-8;
        }

        // The cell at `p`.
        Cell cell_at(float2 p) {
            float2 nearest = (float2)4.0;
            float2 second = (float2)4.0;
            // their squared lengths
            float first_square = 32.0;
            float second_square = 32.0;
            uint owner = 0u;
            // relative to the cell's corner, so that precision does not depend on the distance from the origin
            float2 home = floor(p);
            float2 within = p - home;
            [unroll]
            for (int j = -1; j <= 1; j++) {
                [unroll]
                for (int i = -1; i <= 1; i++) {
                    float2 offset = float2(float(i), float(j));
                    float2 corner = home + offset;
                    uint seed = hash_bits(uint(int(corner.x)) + hash_bits(uint(int(corner.y)) + 1u));
                    float2 shift = float2(hash_unit(seed + 1u), hash_unit(seed + 2u)) - 0.5;
                    float2 to_site = offset + 0.5 + JITTER * shift - within;
                    float square = dot(to_site, to_site);
                    if (square < first_square) {
                        second = nearest;
                        second_square = first_square;
                        nearest = to_site;
                        first_square = square;
                        owner = seed;
                    } else if (square < second_square) {
                        second = to_site;
                        second_square = square;
                    }
                }
            }
            float level = 1.0 - _Variation * hash_unit(owner + 3u);
            Cell cell = { nearest, second, level };
            return cell;
        }

        // How much farther the second nearest site is than the nearest one: 0 on the edges.
        float to_edge(Cell cell) {
            return length(cell.second) - length(cell.nearest);
        }

        // Thickness in Voronoi cells: facets with thin edges between them, as in cracked ice.
        float voronoi_thickness(float2 uv) {
            Cell cell = cell_at(uv * _CellCount);
            return _ThicknessFactor * cell.level * smoothstep(0.0, _Bevel, to_edge(cell));
        }

        // The thickness `d` in mean free paths, 0 or more.
        float optical_depth(float d, float mean_free_path) {
            float path = max(mean_free_path, OPAQUE_DISTANCE);
            return clamp(d, 0.0, ENDLESS * path) / path;
        }

        // Thickness to transmittance: the part of the light that absorption leaves.
        float beer_lambert(float d) {
            return exp(-min(optical_depth(d, _AttenuationDistance), OPAQUE_DEPTH));
        }

        // Colour and opacity from a texture and a tint.
        void base_color(float2 uv, out float3 albedo, out float alpha) {
            float4 texel = _Tint * tex2D(_BaseColorTexture, uv);
            albedo = texel.xyz;
            alpha = texel.w;
        }

        // The same metalness and roughness everywhere.
        void pbr_constants(out float metallic, out float roughness) {
            metallic = _Metalness;
            roughness = _SurfaceRoughness;
        }

        // The gradient of to_edge.
        float2 from_edge(Cell cell) {
            // the nearest site may be exactly here, the second one cannot: they are at least 0.4 apart
            return safe_normalize(cell.nearest) - normalize(cell.second);
        }

        // Adds `detail` to `base`: x and y are added, z is multiplied; for small slopes this adds the slopes.
        float3 blend_normals(float3 base, float3 detail) {
            return safe_normalize(float3(base.xy + detail.xy, base.z * detail.z));
        }

        // The normal of a height field; `slope` is the increase in height per unit of length along T and B.
        float3 normal_of_slope(float2 slope) {
            return normalize(float3(-slope, 1.0));
        }

        // The normal of the Voronoi cells, so that reflected light agrees with transmitted light.
        void voronoi_normal(float2 uv, inout float3 normal) {
            Cell cell = cell_at(uv * _CellCount);
            float x = clamp(to_edge(cell) / _Bevel, 0.0, 1.0);
            // the derivative of the smoothstep
            float steepness = cell.level * 6.0 * x * (1.0 - x) / _Bevel;
            float2 slope = _Relief * _UvPerUnit * _CellCount * steepness * from_edge(cell);
            normal = blend_normals(normal, normal_of_slope(slope));
        }

        // Only the bare ice transmits light.
        void ice_mask(float2 uv, inout float through) {
            float covered = _Cover * tex2D(_CoverTexture, uv).r;
            through = through * smoothstep(0.0, 0.1, 1.0 - covered);
        }

        // One moving layer; the offset stays below 1, so that precision does not decrease with time.
        float4 layer(float2 uv, float2 speed, float time) {
            return tex2D(_PackedTexture, uv + frac(speed * time));
        }

        // Moving light below the surface, from the channels of one texture, each of which scrolls separately.
        void packed_scroll(float2 uv, float time, inout float3 emission) {
            float veins = layer(uv, _RedSpeed, time).x * layer(uv, _GreenSpeed, time).y;
            float sparks = layer(uv, _BlueSpeed, time).z;
            emission = min(emission + (_VeinColor * veins + _SparkColor * sparks), 65504.0);
        }

        // The part of the surface that remains at `uv`: 1 = all, 0 = none.
        float left_at(float2 uv) {
            // the threshold goes from below black to white, so that erosion 0 keeps and erosion 1 removes everything
            float threshold = lerp(-_Edge, 1.0, _Erosion);
            return clamp((tex2D(_ErosionTexture, uv).r - threshold) / _Edge, 0.0, 1.0);
        }

        // Erodes the surface, dark parts of a mask first, with a bevelled normal at the edge.
        void alpha_erosion(float2 uv, inout float alpha, inout float3 normal) {
            float2 e = float2(_TexelSize, 0.0);
            float across = left_at(uv + e) - left_at(uv - e);
            float up = left_at(uv + e.yx) - left_at(uv - e.yx);
            float2 slope = _EdgeHeight * _UvPerUnit * float2(across, up) / (2.0 * _TexelSize);
            normal = blend_normals(normal, normal_of_slope(slope));
            alpha *= left_at(uv);
        }

        // The transmitted light for a lobe value of 0..1 and a transmittance.
        float3 glow(float lobe, float through) {
            return _SubsurfaceColor * (_Attenuation * (lobe * _Scale + _Ambient) * through);
        }

        // The back-light lobe with a unit half vector: the lobe of Alisavakis and Unity ice, corrected.
        float3 lobe_normalized(float3 V, float3 N, float3 L, float through) {
            float3 bent = safe_normalize(L + N * _Distortion);
            return glow(pow(clamp(dot(V, -bent), 0.0, 1.0), _Power), through);
        }

        // The light of the surroundings that comes through, for the mean of a lobe over the directions behind the
        // body.
        float3 lobe_surroundings(float mean_lobe, float through, float3 irradiance_behind) {
            // the light of half a sphere is 2 where the irradiance is 1
            return 2.0 * glow(mean_lobe, through) * irradiance_behind;
        }

        // The light of the surroundings that comes through.
        float3 lobe_normalized_surroundings(float through, float3 irradiance_behind) {
            return lobe_surroundings(1.0 / (_Power + 1.0), through, irradiance_behind);
        }

        // The values of the surface that do not depend on a light.
        Surface evaluate_surface(float2 uv, float time, float3 irradiance_behind) {
            float thickness = voronoi_thickness(uv);
            float transmittance = beer_lambert(thickness);
            float3 albedo;
            float alpha;
            base_color(uv, albedo, alpha);
            float metallic;
            float roughness;
            pbr_constants(metallic, roughness);
            float3 normal = float3(0.0, 0.0, 1.0);
            voronoi_normal(uv, normal);
            ice_mask(uv, transmittance);
            float3 emission = (float3)0.0;
            packed_scroll(uv, time, emission);
            alpha_erosion(uv, alpha, normal);
            emission += lobe_normalized_surroundings(transmittance, irradiance_behind);
            Surface surface = { albedo, alpha, normal, metallic, roughness, emission, transmittance };
            return surface;
        }

        // The transmitted light of one light, as a factor on its colour.
        float3 evaluate_translucency(Surface surface, float3 V, float3 N, float3 L) {
            return lobe_normalized(V, N, L, surface.transmittance);
        }
        #endif

        struct Input {
            float2 texcoord;
            float3 worldPos;
            float3 worldNormal;
            INTERNAL_DATA
        };

        // Unity's standard output, and what the lights read beside it.
        struct SurfaceOutputSss {
            half3 Albedo;
            float3 Normal;
            half3 Emission;
            half Metallic;
            half Smoothness;
            half Occlusion;
            half Alpha;
            Surface surface;
        };

        void vert(inout appdata_full v, out Input o) {
            UNITY_INITIALIZE_OUTPUT(Input, o);
            o.texcoord = v.texcoord.xy;
        }

        void surf(Input input, inout SurfaceOutputSss o) {
            float3 N = safe_normalize(WorldNormalVector(input, float3(0.0, 0.0, 1.0)));
            Surface surface = evaluate_surface(input.texcoord, _Time.y, ShadeSH9(half4(-N, 1.0)));
            o.Albedo = surface.albedo;
            o.Alpha = surface.alpha;
            clip(surface.alpha - 0.5);
            o.Normal = surface.normal;
            o.Smoothness = 1.0 - surface.roughness;
            o.Emission = surface.emission;
            o.Metallic = surface.metallic;
            o.surface = surface;
        }

        SurfaceOutputStandard standard_surface(SurfaceOutputSss s) {
            SurfaceOutputStandard standard;
            standard.Albedo = s.Albedo;
            standard.Normal = s.Normal;
            standard.Emission = s.Emission;
            standard.Metallic = s.Metallic;
            standard.Smoothness = s.Smoothness;
            standard.Occlusion = s.Occlusion;
            standard.Alpha = s.Alpha;
            return standard;
        }

        half4 LightingSss(SurfaceOutputSss s, float3 viewDir, UnityGI gi) {
            half4 color = LightingStandard(standard_surface(s), viewDir, gi);
            // Light that comes through entered on the far side, in the object's own shadow. A directional light can be
            // had without that shadow; a point light's shadow and falloff come multiplied.
        #if defined(DIRECTIONAL)
            float3 light_color = _LightColor0.rgb;
        #else
            float3 light_color = gi.light.color;
        #endif
            color.rgb += evaluate_translucency(s.surface, viewDir, safe_normalize(s.Normal), gi.light.dir) * light_color;
            return color;
        }

        void LightingSss_GI(SurfaceOutputSss s, UnityGIInput data, inout UnityGI gi) {
            LightingStandard_GI(standard_surface(s), data, gi);
        }
        ENDCG
    }
    FallBack "Diffuse"
}

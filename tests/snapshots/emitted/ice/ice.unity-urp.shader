// Ice: Cracked ice in facets: back light, moving veins below the surface, a cover of snow, and holes
// that melt into it.
// Made by sssgen for Unity, Universal Render Pipeline. Change the material and emit it again rather than this file.
Shader "sssgen/Ice (URP)" {
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
        _TransmissionShadowOffset ("Transmission shadow offset", Float) = 0
    }
    SubShader {
        Tags { "RenderPipeline" = "UniversalPipeline" "RenderType" = "TransparentCutout" "Queue" = "AlphaTest" }

        // Every pass sees the same material block, which the SRP batcher asks for.
        HLSLINCLUDE
        #include "Packages/com.unity.render-pipelines.universal/ShaderLibrary/Lighting.hlsl"

        CBUFFER_START(UnityPerMaterial)
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
            float _TransmissionShadowOffset;  // Towards the light, at least the size of the body; 0: that of the renderer's box
        CBUFFER_END

        TEXTURE2D(_BaseColorTexture); SAMPLER(sampler_BaseColorTexture);
        TEXTURE2D(_CoverTexture); SAMPLER(sampler_CoverTexture);
        TEXTURE2D(_PackedTexture); SAMPLER(sampler_PackedTexture);
        TEXTURE2D(_ErosionTexture); SAMPLER(sampler_ErosionTexture);

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

        float3 mix_(float3 x, float3 y, bool3 a) {
            return float3(a.x ? y.x : x.x, a.y ? y.y : x.y, a.z ? y.z : x.z);
        }

        // How far light travelled inside a box that contains the body: from where it entered the box to a point `at`
        // of the body, in lengths of `towards`, which points to the light.
        float way_out_of_box(float3 at, float3 towards, float3 box_min, float3 box_max) {
            // a component of 0 never leaves the box
            float3 slopes = max(abs(towards), (float3)1.0e-12);
            float3 side = mix_(at - box_min, box_max - at, towards > (float3)0.0);
            float3 ways = max(side, 0.0) / slopes;
            return min(min(ways.x, ways.y), ways.z);
        }

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
            float4 texel = _Tint * SAMPLE_TEXTURE2D(_BaseColorTexture, sampler_BaseColorTexture, uv);
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
            float covered = _Cover * SAMPLE_TEXTURE2D(_CoverTexture, sampler_CoverTexture, uv).r;
            through = through * smoothstep(0.0, 0.1, 1.0 - covered);
        }

        // One moving layer; the offset stays below 1, so that precision does not decrease with time.
        float4 layer(float2 uv, float2 speed, float time) {
            return SAMPLE_TEXTURE2D(_PackedTexture, sampler_PackedTexture, uv + frac(speed * time));
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
            return clamp((SAMPLE_TEXTURE2D(_ErosionTexture, sampler_ErosionTexture, uv).r - threshold) / _Edge, 0.0,
                1.0);
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

        struct Attributes {
            float4 positionOS : POSITION;
            float3 normalOS : NORMAL;
            float4 tangentOS : TANGENT;
            float2 uv : TEXCOORD0;
            float2 uv2 : TEXCOORD1;
            UNITY_VERTEX_INPUT_INSTANCE_ID
        };

        struct Varyings {
            float4 positionCS : SV_POSITION;
            float3 positionWS : TEXCOORD0;
            float3 normalWS : TEXCOORD1;
            float4 tangentWS : TEXCOORD2;  // w: handedness, +1 or -1
            float2 uv : TEXCOORD3;
            float fogFactor : TEXCOORD4;
            UNITY_VERTEX_INPUT_INSTANCE_ID
            UNITY_VERTEX_OUTPUT_STEREO
        };

        Varyings vert(Attributes input) {
            Varyings output = (Varyings)0;
            UNITY_SETUP_INSTANCE_ID(input);
            UNITY_TRANSFER_INSTANCE_ID(input, output);
            UNITY_INITIALIZE_VERTEX_OUTPUT_STEREO(output);
            output.positionWS = TransformObjectToWorld(input.positionOS.xyz);
            output.positionCS = TransformWorldToHClip(output.positionWS);
            output.normalWS = TransformObjectToWorldNormal(input.normalOS);
            output.tangentWS = float4(TransformObjectToWorldDir(input.tangentOS.xyz), input.tangentOS.w * GetOddNegativeScale());
            output.fogFactor = ComputeFogFactor(output.positionCS.z);
            output.uv = input.uv;
            return output;
        }

        // The surface that a fragment shows.
        Surface surface_at(Varyings input) {
            float3 N = safe_normalize(input.normalWS);
            return evaluate_surface(input.uv, _Time.y, SampleSH(-N));
        }

        // The surface as URP's lighting takes it.
        SurfaceData surface_data(Surface surface) {
            SurfaceData data = (SurfaceData)0;
            data.albedo = surface.albedo;
            data.alpha = surface.alpha;
            data.metallic = surface.metallic;
            data.smoothness = 1.0 - surface.roughness;
            data.occlusion = 1.0;
            data.emission = surface.emission;
            return data;
        }
        ENDHLSL

        // Forward in the deferred renderer too: a G-buffer has no room for translucency.
        Pass {
            Name "ForwardLit"
            Tags { "LightMode" = "UniversalForwardOnly" }

            HLSLPROGRAM
            #pragma target 3.5
            #pragma vertex vert
            #pragma fragment frag
            #pragma multi_compile_instancing
            #pragma multi_compile _ _MAIN_LIGHT_SHADOWS _MAIN_LIGHT_SHADOWS_CASCADE _MAIN_LIGHT_SHADOWS_SCREEN
            #pragma multi_compile _ _ADDITIONAL_LIGHTS
            #pragma multi_compile _ _LIGHT_LAYERS
            #pragma multi_compile_fragment _ _ADDITIONAL_LIGHT_SHADOWS
            #pragma multi_compile_fragment _ _LIGHT_COOKIES
            #pragma multi_compile_fragment _ _SCREEN_SPACE_OCCLUSION
            #pragma multi_compile_fragment _ _REFLECTION_PROBE_BLENDING
            #pragma multi_compile_fragment _ _REFLECTION_PROBE_BOX_PROJECTION
            // Names that depend on the version: soft shadows, the lists of lights per part of the screen, probe volumes.
            #if UNITY_VERSION >= 202310
            #pragma multi_compile_fragment _ _SHADOWS_SOFT _SHADOWS_SOFT_LOW _SHADOWS_SOFT_MEDIUM _SHADOWS_SOFT_HIGH
            #else
            #pragma multi_compile_fragment _ _SHADOWS_SOFT
            #endif
            #if UNITY_VERSION >= 60000100
            #pragma multi_compile _ _CLUSTER_LIGHT_LOOP
            #elif UNITY_VERSION >= 202220
            #pragma multi_compile _ _FORWARD_PLUS
            #else
            #pragma multi_compile _ _CLUSTERED_RENDERING
            #endif
            #if UNITY_VERSION >= 60000000
            #pragma multi_compile _ PROBE_VOLUMES_L1 PROBE_VOLUMES_L2
            #endif
            #pragma instancing_options renderinglayer
            #pragma multi_compile_fog

            // 1 for a light of the object's rendering layers, else 0.
            float in_layers(uint light_layers) {
            #if defined(_LIGHT_LAYERS)
            #if UNITY_VERSION >= 202220
                uint layers = GetMeshRenderingLayer();
            #else
                uint layers = GetMeshRenderingLightLayer();
            #endif
                return IsMatchingLightLayer(light_layers, layers) ? 1.0 : 0.0;
            #else
                return 1.0;
            #endif
            }

            // The index in URP's arrays of a light that has the index `number` for GetAdditionalLight.
            int light_index(uint number) {
            #if !defined(_ADDITIONAL_LIGHTS) || USE_FORWARD_PLUS || USE_CLUSTERED_LIGHTING || USE_CLUSTER_LIGHT_LOOP
                return int(number);
            #else
                return GetPerObjectLightIndex(number);
            #endif
            }

            // 1 over the distance of such a light, 0 for one from afar.
            float light_nearness_at(uint number, float3 place) {
            #if defined(_ADDITIONAL_LIGHTS)
            #if USE_STRUCTURED_BUFFER_FOR_LIGHT_DATA
                float4 light_place = _AdditionalLightsBuffer[light_index(number)].position;
            #else
                float4 light_place = _AdditionalLightsPosition[light_index(number)];
            #endif
                return light_place.w / max(distance(light_place.xyz, place), 0.01);
            #else
                return 0.0;
            #endif
            }

            // How far from a place of the body, towards a light, the shadow map is read: where the light enters the
            // renderer's box. The place itself lies in the shadow of its own body. 0: the box is unknown.
            float way_to_entry(float3 place, float3 L) {
                float way = _TransmissionShadowOffset;
            #if UNITY_VERSION >= 202220
                // The margin: where the body touches the box, texels of the shadow map are partly its own.
                float margin = 0.02 * distance(unity_RendererBounds_Min.xyz, unity_RendererBounds_Max.xyz);
                if (way <= 0.0 && margin > 0.0) {
                    way = margin + way_out_of_box(place, L, unity_RendererBounds_Min.xyz, unity_RendererBounds_Max.xyz);
                }
            #endif
                return way;
            }

            // The shares of the main light and of an additional one that are not in the shadow of other bodies.
            float main_light_at_entry(float3 place, float3 L) {
                float share = 1.0;
            #if !defined(_MAIN_LIGHT_SHADOWS_SCREEN)  // screen space has the shadow at the surface alone
                float way = way_to_entry(place, L);
                if (way > 0.0) {
                    float3 entry = place + L * way;
                    share = MainLightShadow(TransformWorldToShadowCoord(entry), entry, 1.0, 1.0);
                }
            #endif
                return share;
            }

            float additional_light_at_entry(uint number, float3 place, float3 L) {
                float share = 1.0;
                float way = way_to_entry(place, L);
                if (way > 0.0) {
                    way /= max(1.0, way * light_nearness_at(number, place) / 0.99);  // not beyond a lamp in the box
                    share = AdditionalLightShadow(light_index(number), place + L * way, L, 1.0, 1.0);
                }
                return share;
            }

            float4 frag(Varyings input) : SV_Target {
                UNITY_SETUP_INSTANCE_ID(input);
                UNITY_SETUP_STEREO_EYE_INDEX_POST_VERTEX(input);
                Surface surface = surface_at(input);
                clip(surface.alpha - 0.5);
                float3 V = safe_normalize(GetWorldSpaceViewDir(input.positionWS));
                float3 N = safe_normalize(input.normalWS);
                float3 T = safe_normalize(input.tangentWS.xyz);
                float3 B = cross(N, T) * input.tangentWS.w;
                N = safe_normalize(T * surface.normal.x + B * surface.normal.y + N * surface.normal.z);

                InputData inputData = (InputData)0;
                inputData.positionWS = input.positionWS;
                inputData.normalWS = N;
                inputData.viewDirectionWS = V;
                inputData.normalizedScreenSpaceUV = GetNormalizedScreenSpaceUV(input.positionCS);
            #if defined(_MAIN_LIGHT_SHADOWS_SCREEN)
                inputData.shadowCoord = float4(inputData.normalizedScreenSpaceUV, 0.0, 1.0);
            #else
                inputData.shadowCoord = TransformWorldToShadowCoord(input.positionWS);
            #endif
                inputData.shadowMask = 1.0;
            #if defined(PROBE_VOLUMES_L1) || defined(PROBE_VOLUMES_L2)
                float3 probe_place = GetAbsolutePositionWS(input.positionWS);
                inputData.bakedGI = SampleProbeVolumePixel(0.0, probe_place, N, V, input.positionCS.xy);
            #else
                inputData.bakedGI = SampleSH(N);
            #endif
                float4 color = UniversalFragmentPBR(inputData, surface_data(surface));

                // Without the object's own shadow: light that comes through entered on the far side.
                Light light = GetMainLight(inputData.shadowCoord, input.positionWS, inputData.shadowMask);  // with its cookie
                float3 light_color = light.color * (light.distanceAttenuation * in_layers(light.layerMask));
                light_color *= main_light_at_entry(input.positionWS, light.direction);
                color.rgb += evaluate_translucency(surface, V, N, light.direction) * light_color;
            #if defined(_ADDITIONAL_LIGHTS)
            #if USE_CLUSTER_LIGHT_LOOP || USE_FORWARD_PLUS || USE_CLUSTERED_LIGHTING
                // The loop below has the lights near this part of the screen; directional ones come first in the array.
            #if USE_CLUSTERED_LIGHTING
                uint directional_count = min(_AdditionalLightsDirectionalCount, MAX_VISIBLE_LIGHTS);
            #else
                uint directional_count = min(URP_FP_DIRECTIONAL_LIGHTS_COUNT, MAX_VISIBLE_LIGHTS);
            #endif
                for (uint number = 0u; number < directional_count; number++) {
                    light = GetAdditionalLight(number, input.positionWS, inputData.shadowMask);
                    light_color = light.color * (light.distanceAttenuation * in_layers(light.layerMask));
                    light_color *= additional_light_at_entry(number, input.positionWS, light.direction);
                    color.rgb += evaluate_translucency(surface, V, N, light.direction) * light_color;
                }
            #endif
                uint light_count = GetAdditionalLightsCount();
                LIGHT_LOOP_BEGIN(light_count)
                    light = GetAdditionalLight(lightIndex, input.positionWS, inputData.shadowMask);
                    light_color = light.color * (light.distanceAttenuation * in_layers(light.layerMask));
                    light_color *= additional_light_at_entry(lightIndex, input.positionWS, light.direction);
                    color.rgb += evaluate_translucency(surface, V, N, light.direction) * light_color;
                LIGHT_LOOP_END
            #endif
                color.rgb = MixFog(color.rgb, input.fogFactor);
                return color;
            }
            ENDHLSL
        }

        Pass {
            Name "ShadowCaster"
            Tags { "LightMode" = "ShadowCaster" }
            ColorMask 0

            HLSLPROGRAM
            #pragma target 3.5
            #pragma vertex vert_shadow
            #pragma fragment frag
            #pragma multi_compile_instancing
            #pragma multi_compile_vertex _ _CASTING_PUNCTUAL_LIGHT_SHADOW

            float3 _LightDirection;
            float3 _LightPosition;

            Varyings vert_shadow(Attributes input) {
                Varyings output = vert(input);
            #if defined(_CASTING_PUNCTUAL_LIGHT_SHADOW)
                float3 L = safe_normalize(_LightPosition - output.positionWS);
            #else
                float3 L = _LightDirection;
            #endif
                output.positionCS = TransformWorldToHClip(ApplyShadowBias(output.positionWS, output.normalWS, L));
                // What lies before the light's near plane still casts its shadow.
            #if UNITY_REVERSED_Z
                output.positionCS.z = min(output.positionCS.z, UNITY_NEAR_CLIP_VALUE);
            #else
                output.positionCS.z = max(output.positionCS.z, UNITY_NEAR_CLIP_VALUE);
            #endif
                return output;
            }

            float4 frag(Varyings input) : SV_Target {
                UNITY_SETUP_INSTANCE_ID(input);
                UNITY_SETUP_STEREO_EYE_INDEX_POST_VERTEX(input);
                Surface surface = surface_at(input);
                clip(surface.alpha - 0.5);
                return 0.0;
            }
            ENDHLSL
        }

        Pass {
            Name "DepthOnly"
            Tags { "LightMode" = "DepthOnly" }
            ColorMask 0

            HLSLPROGRAM
            #pragma target 3.5
            #pragma vertex vert
            #pragma fragment frag
            #pragma multi_compile_instancing

            float4 frag(Varyings input) : SV_Target {
                UNITY_SETUP_INSTANCE_ID(input);
                UNITY_SETUP_STEREO_EYE_INDEX_POST_VERTEX(input);
                Surface surface = surface_at(input);
                clip(surface.alpha - 0.5);
                return 0.0;
            }
            ENDHLSL
        }

        // The geometric normal, for screen-space occlusion.
        Pass {
            Name "DepthNormals"
            Tags { "LightMode" = "DepthNormalsOnly" }

            HLSLPROGRAM
            #pragma target 3.5
            #pragma vertex vert
            #pragma fragment frag
            #pragma multi_compile_instancing
            #pragma multi_compile_fragment _ _GBUFFER_NORMALS_OCT

            float4 frag(Varyings input) : SV_Target {
                UNITY_SETUP_INSTANCE_ID(input);
                UNITY_SETUP_STEREO_EYE_INDEX_POST_VERTEX(input);
                Surface surface = surface_at(input);
                clip(surface.alpha - 0.5);
                float3 N = safe_normalize(input.normalWS);
            #if defined(_GBUFFER_NORMALS_OCT)
                return float4(PackFloat2To888(saturate(0.5 * PackNormalOctQuadEncode(N) + 0.5)), 0.0);
            #else
                return float4(N, 0.0);
            #endif
            }
            ENDHLSL
        }

        // What the lightmapper and probe volumes read: the light that the surface reflects and emits.
        Pass {
            Name "Meta"
            Tags { "LightMode" = "Meta" }
            Cull Off

            HLSLPROGRAM
            #pragma target 3.5
            #pragma vertex vert_meta
            #pragma fragment frag
            #pragma multi_compile_instancing
            #include "Packages/com.unity.render-pipelines.universal/ShaderLibrary/MetaInput.hlsl"

            Varyings vert_meta(Attributes input, float2 dynamic_lightmap_uv : TEXCOORD2) {
                Varyings output = vert(input);
                output.positionCS = UnityMetaVertexPosition(input.positionOS.xyz, input.uv2, dynamic_lightmap_uv);
                return output;
            }

            float4 frag(Varyings input) : SV_Target {
                UNITY_SETUP_INSTANCE_ID(input);
                UNITY_SETUP_STEREO_EYE_INDEX_POST_VERTEX(input);
                Surface surface = surface_at(input);
                clip(surface.alpha - 0.5);
                SurfaceData data = surface_data(surface);
                BRDFData brdf;
                InitializeBRDFData(data.albedo, data.metallic, data.specular, data.smoothness, data.alpha, brdf);
                UnityMetaInput light = (UnityMetaInput)0;
                light.Albedo = brdf.diffuse + brdf.specular * brdf.roughness * 0.5;  // as URP's own materials
                light.Emission = data.emission;
                return UnityMetaFragment(light);
            }
            ENDHLSL
        }
    }
    FallBack "Hidden/Universal Render Pipeline/FallbackError"
}

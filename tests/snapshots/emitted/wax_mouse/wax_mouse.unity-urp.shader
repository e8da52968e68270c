// Wax mouse: A candle in the shape of a mouse: the ears glow, the body stays deep.
// Made by sssgen for Unity, Universal Render Pipeline. Change the material and emit it again rather than this file.
Shader "sssgen/Wax mouse (URP)" {
    Properties {
        [NoScaleOffset] _DistanceMap ("Distance map", 3D) = "" {}
        [NoScaleOffset] _BaseColorTexture ("Base color texture", 2D) = "white" {}
        _BoxMax ("Box max", Vector) = (-1, 2.35, 5.05, 0)
        _BoxMin ("Box min", Vector) = (-4, 0.15, 3.15, 0)
        _DistanceRange ("Distance range", Range(0.001, 100)) = 1
        _ObjectScale ("Object scale", Range(0.001, 1000)) = 1
        [HDR] _Tint ("Tint", Color) = (0.93, 0.86, 0.7, 1)
        _Metalness ("Metalness", Range(0, 1)) = 0
        _SurfaceRoughness ("Surface roughness", Range(0, 1)) = 0.4
        [HDR] _AttenuationColor ("Attenuation color", Color) = (0.95, 0.62, 0.3, 1)
        _AttenuationDistance ("Attenuation distance", Range(0, 10)) = 0.35
        _Weight ("Weight", Range(0, 1)) = 0.6
    }
    SubShader {
        Tags {
            "RenderPipeline" = "UniversalPipeline"
            "RenderType" = "Opaque"
            "Queue" = "Geometry"
        }

        // Every pass sees the same material block, which the SRP batcher asks for.
        HLSLINCLUDE
        #include "Packages/com.unity.render-pipelines.universal/ShaderLibrary/Lighting.hlsl"

        CBUFFER_START(UnityPerMaterial)
            float3 _BoxMax;  // The box's largest corner
            float3 _BoxMin;  // The box's smallest corner
            float _DistanceRange;  // The distance that the texture's 1 stands for
            float _ObjectScale;  // World units in one unit of object space (uniform scale)
            float4 _Tint;  // Multiplies the texture
            float _Metalness;  // 0 = not a metal, 1 = metal
            float _SurfaceRoughness;  // 0 = a mirror, 1 = chalk
            float3 _AttenuationColor;  // The colour that white light has after attenuation_distance
            float _AttenuationDistance;  // The length after which white light has attenuation_color; 0 = opaque
            float _Weight;  // How much of the light goes in at all
        CBUFFER_END

        TEXTURE3D(_DistanceMap); SAMPLER(sampler_DistanceMap);
        TEXTURE2D(_BaseColorTexture); SAMPLER(sampler_BaseColorTexture);

        struct Surface {
            float3 albedo;
            float metallic;
            float roughness;
        };

        static const float NEGLIGIBLE = 1.0e-6;
        static const float DARKEST = 0.0001;
        static const float OPAQUE_DISTANCE = 1.0e-6;
        static const float ENDLESS = 10000.0;
        static const float OPAQUE_DEPTH = 80.0;

        // The box's size; a flat box is padded to a thousandth of its diagonal, about its centre.
        float3 box_size() {
            return max(_BoxMax - _BoxMin, (float3)(0.001 * distance(_BoxMin, _BoxMax)));
        }

        // The way from the box's centre to `p`.
        float3 from_box_center(float3 p) {
            return p - 0.5 * (_BoxMin + _BoxMax);
        }

        // How far it is from `p`, inside the box, along `direction` to the box's side.
        float box_exit(float3 p, float3 direction) {
            float3 exits = (0.5 * box_size() - from_box_center(p) * float3(sign(direction))) / max(abs(direction),
                1.0e-20);
            // along a zero direction it would be endless
            return clamp(min(exits.x, min(exits.y, exits.z)), 0.0, length(box_size()));
        }

        // The signed distance to a mesh, from a 3-D texture that was baked over a box in object space.
        float distance_texture(float3 p) {
            float3 uvw = clamp(from_box_center(p) / max(box_size(), 1.0e-20) + 0.5, 0.0, 1.0);
            return (2.0 * SAMPLE_TEXTURE3D_LOD(_DistanceMap, sampler_DistanceMap, uvw, 0.0).r - 1.0) * _DistanceRange;
        }

        // The part of a step that is inside the body, where the distance goes from `a` to `b` in a straight line.
        float inside_part(float a, float b) {
            float inside = max(-a, 0.0) + max(-b, 0.0);
            float whole = abs(a) + abs(b);
            return inside / max(whole, 1.0e-20);
        }

        // The length inside the body from `p` to the box's side, along L.
        float length_to_light(float3 p, float3 L) {
            float h = box_exit(p, L) / 8.0;
            float inside = 0.0;
            float before = distance_texture(p);
            // it ends where the body is farther away than the box's side
            [loop]
            for (int i = 1; i <= 8 && before < h * float(9 - i); i++) {
                float after = distance_texture(p + L * (h * float(i)));
                inside += inside_part(before, after);
                before = after;
            }
            return inside * h;
        }

        // Mean length, inside the body, of the light's ways to the eye: in along L, out along V.
        float march_distance_texture(float3 P_object, float3 V_object, float3 L_object) {
            float length_of_view = box_exit(P_object, -V_object);
            float seen = 0.0;
            float way = 0.0;
            float last = 0.0;
            float before = distance_texture(P_object);
            [loop]
            for (int i = 1; i <= 8 && before < length_of_view - last; i++) {
                float x = float(i) / 8.0;
                float t = length_of_view * x * x;
                float after = distance_texture(P_object - V_object * t);
                float inside = (t - last) * inside_part(before, after);
                if (inside > 0.0) {
                    // the light scatters in the middle of what is inside
                    float middle = before < after ? last + 0.5 * inside : t - 0.5 * inside;
                    way += inside * (seen + 0.5 * inside + length_to_light(P_object - V_object * middle, L_object));
                    seen += inside;
                }
                before = after;
                last = t;
            }
            if (seen < NEGLIGIBLE) {
                // a view that only grazes the body sees the light leave where it is
                return _ObjectScale * length_to_light(P_object, L_object);
            }
            float mean = way / seen;
            return _ObjectScale * mean;
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

        // `d` in mean free paths, 0 or more.
        float optical_depth(float d, float mean_free_path) {
            float path = max(mean_free_path, OPAQUE_DISTANCE);
            return clamp(d, 0.0, ENDLESS * path) / path;
        }

        // Light that comes through coloured by what the body absorbs: deeper colours where it is thicker.
        float3 absorption_tint(float d) {
            float3 sigma_d = -log(clamp(_AttenuationColor, DARKEST, 1.0)) * optical_depth(d, _AttenuationDistance);
            return _Weight * exp(-min(sigma_d, OPAQUE_DEPTH));
        }

        // Everything about the surface that does not depend on a light.
        Surface evaluate_surface(float2 uv) {
            float3 albedo;
            float alpha;
            base_color(uv, albedo, alpha);
            float metallic;
            float roughness;
            pbr_constants(metallic, roughness);
            Surface surface = { albedo, metallic, roughness };
            return surface;
        }

        // What one light adds from behind, as a factor on its colour.
        float3 evaluate_translucency(Surface surface, float3 P_object, float3 V_object, float3 L_object) {
            float thickness = march_distance_texture(P_object, V_object, L_object);
            return absorption_tint(thickness);
        }

        // v / |v|; 0 stays 0, of which normalize makes NaN.
        float3 unit_vector(float3 v) {
            float square = dot(v, v);
            return square > 1e-30 ? v * rsqrt(square) : float3(0.0, 0.0, 0.0);
        }

        struct Attributes {
            float4 positionOS : POSITION;
            float3 normalOS : NORMAL;
            float2 uv : TEXCOORD0;
            UNITY_VERTEX_INPUT_INSTANCE_ID
        };

        struct Varyings {
            float4 positionCS : SV_POSITION;
            float3 positionWS : TEXCOORD0;
            float3 normalWS : TEXCOORD1;
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
            output.uv = input.uv;
            output.fogFactor = ComputeFogFactor(output.positionCS.z);
            return output;
        }
        ENDHLSL

        Pass {
            // Forward in the deferred renderer too: a G-buffer has no room for translucency.
            Name "ForwardLit"
            Tags { "LightMode" = "UniversalForwardOnly" }

            HLSLPROGRAM
            #pragma target 3.5
            #pragma vertex vert
            #pragma fragment frag
            #pragma multi_compile _ _MAIN_LIGHT_SHADOWS _MAIN_LIGHT_SHADOWS_CASCADE _MAIN_LIGHT_SHADOWS_SCREEN
            #pragma multi_compile _ _ADDITIONAL_LIGHTS
            #pragma multi_compile_fragment _ _ADDITIONAL_LIGHT_SHADOWS
            #pragma multi_compile_fragment _ _SHADOWS_SOFT
            #pragma multi_compile_fragment _ _SCREEN_SPACE_OCCLUSION
            #pragma multi_compile _ _CLUSTERED_RENDERING _FORWARD_PLUS
            #pragma multi_compile_fog
            #pragma multi_compile_instancing

            float4 frag(Varyings input) : SV_Target {
                UNITY_SETUP_INSTANCE_ID(input);
                UNITY_SETUP_STEREO_EYE_INDEX_POST_VERTEX(input);
                float3 V = unit_vector(GetWorldSpaceViewDir(input.positionWS));
                float3 N = unit_vector(input.normalWS);
                Surface surface = evaluate_surface(input.uv);

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
                inputData.bakedGI = SampleSH(N);

                SurfaceData surfaceData = (SurfaceData)0;
                surfaceData.albedo = surface.albedo;
                surfaceData.metallic = surface.metallic;
                surfaceData.smoothness = 1.0 - surface.roughness;
                surfaceData.occlusion = 1.0;
                surfaceData.alpha = 1.0;
                float4 color = UniversalFragmentPBR(inputData, surfaceData);

                // Without shadow: light that comes through entered on the far side, in the object's own shadow.
                Light light = GetMainLight();
                float3 light_color = light.color * light.distanceAttenuation;
                color.rgb += evaluate_translucency(surface, TransformWorldToObject(input.positionWS), unit_vector(mul((float3x3)GetWorldToObjectMatrix(), V)), unit_vector(mul((float3x3)GetWorldToObjectMatrix(), light.direction))) * light_color;
            #if defined(_ADDITIONAL_LIGHTS)
                uint light_count = GetAdditionalLightsCount();
                LIGHT_LOOP_BEGIN(light_count)
                    light = GetAdditionalLight(lightIndex, input.positionWS);
                    light_color = light.color * light.distanceAttenuation;
                    color.rgb += evaluate_translucency(surface, TransformWorldToObject(input.positionWS), unit_vector(mul((float3x3)GetWorldToObjectMatrix(), V)), unit_vector(mul((float3x3)GetWorldToObjectMatrix(), light.direction))) * light_color;
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
                float3 L = unit_vector(_LightPosition - output.positionWS);
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
                UNITY_SETUP_STEREO_EYE_INDEX_POST_VERTEX(input);
                return 0.0;
            }
            ENDHLSL
        }

        Pass {
            // The geometric normal, for screen-space occlusion.
            Name "DepthNormals"
            Tags { "LightMode" = "DepthNormalsOnly" }

            HLSLPROGRAM
            #pragma target 3.5
            #pragma vertex vert
            #pragma fragment frag
            #pragma multi_compile_instancing
            #pragma multi_compile_fragment _ _GBUFFER_NORMALS_OCT

            float4 frag(Varyings input) : SV_Target {
                UNITY_SETUP_STEREO_EYE_INDEX_POST_VERTEX(input);
                float3 N = unit_vector(input.normalWS);
            #if defined(_GBUFFER_NORMALS_OCT)
                return float4(PackFloat2To888(saturate(0.5 * PackNormalOctQuadEncode(N) + 0.5)), 0.0);
            #else
                return float4(N, 0.0);
            #endif
            }
            ENDHLSL
        }
    }
    FallBack "Hidden/Universal Render Pipeline/FallbackError"
}

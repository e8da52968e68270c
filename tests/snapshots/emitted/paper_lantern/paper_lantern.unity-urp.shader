// Paper lantern: Paper on a frame with a lamp inside: warm light comes through, the wooden ribs stay
// dark.
// Made by sssgen for Unity, Universal Render Pipeline. Change the material and emit it again rather than this file.
Shader "sssgen/Paper lantern (URP)" {
    Properties {
        [NoScaleOffset] _ThicknessTexture ("Thickness texture", 2D) = "black" {}
        [NoScaleOffset] _BaseColorTexture ("Base color texture", 2D) = "white" {}
        [NoScaleOffset] [Normal] _NormalTexture ("Normal texture", 2D) = "bump" {}
        [HDR] _Tint ("Tint", Color) = (1, 1, 1, 1)
        _NormalScale ("Normal scale", Range(0, 4)) = 1
        _Metalness ("Metalness", Range(0, 1)) = 0
        _SurfaceRoughness ("Surface roughness", Range(0, 1)) = 0.85
        _Distortion ("Distortion", Range(0, 1)) = 0.15
        [HDR] _SubsurfaceColor ("Subsurface color", Color) = (1, 0.72, 0.38, 1)
        _Scale ("Scale", Range(0, 20)) = 3
        _Power ("Power", Range(1, 32)) = 4
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
            float4 _Tint;  // Multiplies the texture
            float _NormalScale;  // How strong they are
            float _Metalness;  // 0 = not a metal, 1 = metal
            float _SurfaceRoughness;  // 0 = a mirror, 1 = chalk
            float _Distortion;  // How much the normal bends the light on its way through: 0 ignores the shape
            float3 _SubsurfaceColor;  // Colour of the light that has passed through
            float _Scale;  // Strength of the glow towards the light
            float _Power;  // How tight the glow is around the light: the larger, the smaller the spot
        CBUFFER_END

        TEXTURE2D(_ThicknessTexture); SAMPLER(sampler_ThicknessTexture);
        TEXTURE2D(_BaseColorTexture); SAMPLER(sampler_BaseColorTexture);
        TEXTURE2D(_NormalTexture); SAMPLER(sampler_NormalTexture);

        struct Surface {
            float3 albedo;
            float3 normal;
            float metallic;
            float roughness;
            float transmittance;
        };

        // A texel within its range; 0 in place of NaN.
        float valid_texel(float x) {
            return (asuint(x) & 0x7fffffffu) > 0x7f800000u ? 0.0 : clamp(x, 0.0, 1.0);
        }

        // The direction of `x`; of a zero vector, 0.
        float3 safe_normalize(float3 x) {
            return x * rsqrt(max(dot(x, x), 1.0e-30));
        }

        // Thickness from a baked map, bright where the body is thick.
        float thickness_map(float2 uv) {
            return valid_texel(SAMPLE_TEXTURE2D(_ThicknessTexture, sampler_ThicknessTexture, uv).r);
        }

        // Thickness to thinness, in a straight line.
        float thinness_from_thickness(float d) {
            return clamp(1.0 - d, 0.0, 1.0);
        }

        // Colour and opacity from a texture and a tint.
        void base_color(float2 uv, out float3 albedo, out float alpha) {
            float4 texel = _Tint * SAMPLE_TEXTURE2D(_BaseColorTexture, sampler_BaseColorTexture, uv);
            albedo = texel.xyz;
            alpha = texel.w;
        }

        // Lays `detail` over `base`: x and y add, z multiplies; for gentle normals their slopes add.
        float3 blend_normals(float3 base, float3 detail) {
            return safe_normalize(float3(base.xy + detail.xy, base.z * detail.z));
        }

        // Detail in the normal, from a texture.
        void normal_map(float2 uv, inout float3 normal) {
            float3 texel = UnpackNormal(SAMPLE_TEXTURE2D(_NormalTexture, sampler_NormalTexture, uv));
            normal = blend_normals(normal, float3(texel.xy * _NormalScale, texel.z));
        }

        // The same metalness and roughness everywhere.
        void pbr_constants(out float metallic, out float roughness) {
            metallic = _Metalness;
            roughness = _SurfaceRoughness;
        }

        // The light that comes through where `lobe` (0..1) points at the eye.
        float3 glow(float lobe, float through) {
            return _SubsurfaceColor * (lobe * _Scale * through);
        }

        // The back-light lobe with a unit half vector: the lobe of Alisavakis and Unity ice, corrected.
        float3 lobe_normalized(float3 V, float3 N, float3 L, float through) {
            float3 bent = safe_normalize(L + N * _Distortion);
            return glow(pow(clamp(dot(V, -bent), 0.0, 1.0), _Power), through);
        }

        // Everything about the surface that does not depend on a light.
        Surface evaluate_surface(float2 uv) {
            float thickness = thickness_map(uv);
            float thinness = thinness_from_thickness(thickness);
            float transmittance = thinness;
            float3 albedo;
            float alpha;
            base_color(uv, albedo, alpha);
            float3 normal = float3(0.0, 0.0, 1.0);
            normal_map(uv, normal);
            float metallic;
            float roughness;
            pbr_constants(metallic, roughness);
            Surface surface = { albedo, normal, metallic, roughness, transmittance };
            return surface;
        }

        // What one light adds from behind, as a factor on its colour.
        float3 evaluate_translucency(Surface surface, float3 V, float3 N, float3 L) {
            return lobe_normalized(V, N, L, surface.transmittance);
        }

        // v / |v|; 0 stays 0, of which normalize makes NaN.
        float3 unit_vector(float3 v) {
            float square = dot(v, v);
            return square > 1e-30 ? v * rsqrt(square) : float3(0.0, 0.0, 0.0);
        }

        struct Attributes {
            float4 positionOS : POSITION;
            float3 normalOS : NORMAL;
            float4 tangentOS : TANGENT;
            float2 uv : TEXCOORD0;
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
                float3 T = unit_vector(input.tangentWS.xyz);
                float3 B = cross(N, T) * input.tangentWS.w;
                Surface surface = evaluate_surface(input.uv);
                N = unit_vector(T * surface.normal.x + B * surface.normal.y + N * surface.normal.z);

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
                color.rgb += evaluate_translucency(surface, V, N, light.direction) * light_color;
            #if defined(_ADDITIONAL_LIGHTS)
                uint light_count = GetAdditionalLightsCount();
                LIGHT_LOOP_BEGIN(light_count)
                    light = GetAdditionalLight(lightIndex, input.positionWS);
                    light_color = light.color * light.distanceAttenuation;
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

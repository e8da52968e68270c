// Paper lantern: Paper on a frame with a lamp inside: warm light comes through, the wooden ribs stay
// dark.
// Made by sssgen for Unity, built-in pipeline (surface shader). Change the material and emit it again rather than this file.
Shader "sssgen/Paper lantern" {
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
        Tags { "RenderType" = "Opaque" "Queue" = "Geometry" }

        CGPROGRAM
        // Forward only: a deferred pass has no room for translucency.
        #pragma surface surf Sss fullforwardshadows exclude_path:deferred exclude_path:prepass vertex:vert
        #pragma target 3.5
        #include "UnityPBSLighting.cginc"

        float4 _Tint;  // Multiplies the texture
        float _NormalScale;  // How strong they are
        float _Metalness;  // 0 = not a metal, 1 = metal
        float _SurfaceRoughness;  // 0 = a mirror, 1 = chalk
        float _Distortion;  // How much the normal bends the light on its way through: 0 ignores the shape
        float3 _SubsurfaceColor;  // Colour of the light that has passed through
        float _Scale;  // Strength of the glow towards the light
        float _Power;  // How tight the glow is around the light: the larger, the smaller the spot

        sampler2D _ThicknessTexture;
        sampler2D _BaseColorTexture;
        sampler2D _NormalTexture;

        struct Surface {
            float3 albedo;
            float3 normal;
            float metallic;
            float roughness;
            float transmittance;
        };

        // Unity's first look at a surface shader understands no more than DX9's HLSL, and needs no bodies.
        #if defined(SHADER_TARGET_SURFACE_ANALYSIS_MOJOSHADER)
        Surface evaluate_surface(float2 uv);
        float3 evaluate_translucency(Surface surface, float3 V, float3 N, float3 L);
        #else
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
            return valid_texel(tex2D(_ThicknessTexture, uv).r);
        }

        // Thickness to thinness, in a straight line.
        float thinness_from_thickness(float d) {
            return clamp(1.0 - d, 0.0, 1.0);
        }

        // Colour and opacity from a texture and a tint.
        void base_color(float2 uv, out float3 albedo, out float alpha) {
            float4 texel = _Tint * tex2D(_BaseColorTexture, uv);
            albedo = texel.xyz;
            alpha = texel.w;
        }

        // Lays `detail` over `base`: x and y add, z multiplies; for gentle normals their slopes add.
        float3 blend_normals(float3 base, float3 detail) {
            return safe_normalize(float3(base.xy + detail.xy, base.z * detail.z));
        }

        // Detail in the normal, from a texture.
        void normal_map(float2 uv, inout float3 normal) {
            float3 texel = UnpackNormal(tex2D(_NormalTexture, uv));
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
        #endif

        // v / |v|; 0 stays 0, of which normalize makes NaN.
        float3 unit_vector(float3 v) {
            float square = dot(v, v);
            return square > 1e-30 ? v * rsqrt(square) : float3(0.0, 0.0, 0.0);
        }

        struct Input {
            float2 texcoord;
            float3 worldPos;
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

        void surf(Input IN, inout SurfaceOutputSss o) {
            Surface surface = evaluate_surface(IN.texcoord);
            o.Albedo = surface.albedo;
            o.Normal = surface.normal;
            o.Metallic = surface.metallic;
            o.Smoothness = 1.0 - surface.roughness;
            o.Alpha = 1.0;
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
            color.rgb += evaluate_translucency(s.surface, viewDir, unit_vector(s.Normal), gi.light.dir) * light_color;
            return color;
        }

        void LightingSss_GI(SurfaceOutputSss s, UnityGIInput data, inout UnityGI gi) {
            LightingStandard_GI(standard_surface(s), data, gi);
        }
        ENDCG
    }
    FallBack "Diffuse"
}

// Ice with an inlay: Leaves frozen into a sheet of ice: they lie below its surface, and the sun shines
// through around them.
// Made by sssgen for Unity, built-in pipeline (surface shader). Change the material and emit it again rather than this file.
Shader "sssgen/Ice with an inlay" {
    Properties {
        [NoScaleOffset] _ThicknessTexture ("Thickness texture", 2D) = "black" {}
        [NoScaleOffset] _BaseColorTexture ("Base color texture", 2D) = "white" {}
        _Ior ("Ior", Range(1, 3)) = 1.31
        _Depth ("Depth", Range(0, 1)) = 0.04
        _UvPerUnit ("Uv per unit", Vector) = (1, 1, 0, 0)
        _ThicknessFactor ("Thickness factor", Range(0, 10)) = 0.15
        _AttenuationDistance ("Attenuation distance", Range(0, 10)) = 0.08
        [HDR] _Tint ("Tint", Color) = (1, 1, 1, 1)
        _Metalness ("Metalness", Range(0, 1)) = 0
        _SurfaceRoughness ("Surface roughness", Range(0, 1)) = 0.1
        _Distortion ("Distortion", Range(0, 1)) = 0.1
        [HDR] _SubsurfaceColor ("Subsurface color", Color) = (0.6, 0.88, 1, 1)
        _Scale ("Scale", Range(0, 20)) = 2.5
        _Ambient ("Ambient", Range(0, 1)) = 0.08
        _Power ("Power", Range(1, 32)) = 8
    }
    SubShader {
        Tags { "RenderType" = "Opaque" "Queue" = "Geometry" }

        CGPROGRAM
        // Forward only: a deferred pass has no room for translucency.
        #pragma surface surf Sss fullforwardshadows exclude_path:deferred exclude_path:prepass vertex:vert
        #pragma target 3.5
        #include "UnityPBSLighting.cginc"

        float _Ior;  // Refractive index of the body
        float _Depth;  // How far the image lies below the surface
        float2 _UvPerUnit;  // How far the texture coordinates move for one world unit along T and along B
        float _ThicknessFactor;  // The thickness that white means
        float _AttenuationDistance;  // The length after which 1/e (37 %) of the light is left; 0 = opaque
        float4 _Tint;  // Multiplies the texture
        float _Metalness;  // 0 = not a metal, 1 = metal
        float _SurfaceRoughness;  // 0 = a mirror, 1 = chalk
        float _Distortion;  // How much the normal bends the light on its way through: 0 ignores the shape
        float3 _SubsurfaceColor;  // Colour of the light that has passed through
        float _Scale;  // Strength of the glow towards the light
        float _Ambient;  // Glow that is there from every side
        float _Power;  // How tight the glow is around the light: the larger, the smaller the spot

        sampler2D _ThicknessTexture;
        sampler2D _BaseColorTexture;

        struct Surface {
            float3 albedo;
            float metallic;
            float roughness;
            float transmittance;
        };

        static const float FLAT_FRAME = 0.01;
        static const float OPAQUE_DISTANCE = 1.0e-6;
        static const float ENDLESS = 10000.0;
        static const float OPAQUE_DEPTH = 80.0;

        // Unity's first look at a surface shader understands no more than DX9's HLSL, and needs no bodies.
        #if defined(SHADER_TARGET_SURFACE_ANALYSIS_MOJOSHADER)
        Surface evaluate_surface(float2 uv, float3 V, float3 T, float3 B, float3 N);
        float3 evaluate_translucency(Surface surface, float3 V, float3 N, float3 L);
        #else
        // A texel within its range; 0 in place of NaN.
        float valid_texel(float x) {
            return (asuint(x) & 0x7fffffffu) > 0x7f800000u ? 0.0 : clamp(x, 0.0, 1.0);
        }

        // The components of `v` along unit T, unit B and N. A frame that spans no space gives (0, 0, dot(v, N)).
        float3 tangent_from_world(float3 v, float3 T, float3 B, float3 N) {
            float volume = dot(T, cross(B, N));
            if (abs(volume) < FLAT_FRAME) {
                return float3(0.0, 0.0, dot(v, N));
            }
            float3 along = float3(dot(v, cross(B, N)) * length(T), dot(v, cross(N, T)) * length(B),
                dot(v, cross(T, B)));
            return along / volume;
        }

        // The texture coordinates where `ray`, going in, meets the inner layer.
        float2 slide(float2 uv, float3 ray, float3 T, float3 B, float3 N) {
            float3 r = tangent_from_world(ray, T, B, N);
            // to the surface itself, which a sheared frame does not lie in
            float cosine = -dot(ray, N);
            // 1 / cosine, but smoothly down to 0 where a grazing ray would slide without end
            float x = clamp(cosine / 0.2, 0.0, 1.0);
            float reciprocal = x * x * (4.0 - 3.0 * x) / max(cosine, 0.2);
            return uv + _Depth * reciprocal * _UvPerUnit * r.xy;
        }

        // Subsurface parallax with refraction: the texture as if it were cast into resin, glass or ice.
        float2 parallax_refracted(float2 uv, float3 V, float3 T, float3 B, float3 N) {
            float3 facing = faceforward(N, -V, N);
            // past the critical angle refract() gives 0, which slides nothing
            float3 ray = refract(-V, facing, 1.0 / _Ior);
            return slide(uv, ray, T, B, facing);
        }

        // Thickness from a baked map, bright where the body is thick.
        float thickness_map(float2 uv) {
            return _ThicknessFactor * valid_texel(tex2D(_ThicknessTexture, uv).r);
        }

        // `d` in mean free paths, 0 or more.
        float optical_depth(float d, float mean_free_path) {
            float path = max(mean_free_path, OPAQUE_DISTANCE);
            return clamp(d, 0.0, ENDLESS * path) / path;
        }

        // Thickness to transmittance: what absorption leaves of the light.
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

        // The light that comes through where `lobe` (0..1) points at the eye.
        float3 glow(float lobe, float through) {
            return _SubsurfaceColor * ((lobe * _Scale + _Ambient) * through);
        }

        // The back-light lobe of GDC 2011: the eye looks into light that comes through, bent by the normal.
        float3 lobe_gdc2011(float3 V, float3 N, float3 L, float through) {
            float3 bent = L + N * _Distortion;
            return glow(pow(clamp(dot(V, -bent), 0.0, 1.0), _Power), through);
        }

        // Everything about the surface that does not depend on a light.
        Surface evaluate_surface(float2 uv, float3 V, float3 T, float3 B, float3 N) {
            uv = parallax_refracted(uv, V, T, B, N);
            float thickness = thickness_map(uv);
            float transmittance = beer_lambert(thickness);
            float3 albedo;
            float alpha;
            base_color(uv, albedo, alpha);
            float metallic;
            float roughness;
            pbr_constants(metallic, roughness);
            Surface surface = { albedo, metallic, roughness, transmittance };
            return surface;
        }

        // What one light adds from behind, as a factor on its colour.
        float3 evaluate_translucency(Surface surface, float3 V, float3 N, float3 L) {
            return lobe_gdc2011(V, N, L, surface.transmittance);
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

        void surf(Input IN, inout SurfaceOutputSss o) {
            float3 V = unit_vector(UnityWorldSpaceViewDir(IN.worldPos));
            float3 T = unit_vector(WorldNormalVector(IN, float3(1.0, 0.0, 0.0)));
            float3 B = unit_vector(WorldNormalVector(IN, float3(0.0, 1.0, 0.0)));
            float3 N = unit_vector(WorldNormalVector(IN, float3(0.0, 0.0, 1.0)));
            Surface surface = evaluate_surface(IN.texcoord, V, T, B, N);
            o.Albedo = surface.albedo;
            o.Normal = float3(0.0, 0.0, 1.0);  // written, it gives Input its tangent frame
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

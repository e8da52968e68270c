// Resin inlay: A picture under two centimetres of clear resin: it moves with the eye as if it lay
// below.
// Made by sssgen for Unity, built-in pipeline (surface shader). Change the material and emit it again rather than this file.
Shader "sssgen/Resin inlay" {
    Properties {
        [NoScaleOffset] _BaseColorTexture ("Base color texture", 2D) = "white" {}
        _Ior ("Ior", Range(1, 3)) = 1.5
        _Depth ("Depth", Range(0, 1)) = 0.02
        _UvPerUnit ("Uv per unit", Vector) = (1, 1, 0, 0)
        [HDR] _Tint ("Tint", Color) = (1, 1, 1, 1)
        _Metalness ("Metalness", Range(0, 1)) = 0
        _SurfaceRoughness ("Surface roughness", Range(0, 1)) = 0.08
    }
    SubShader {
        Tags { "RenderType" = "Opaque" "Queue" = "Geometry" }

        CGPROGRAM
        #pragma surface surf Standard fullforwardshadows vertex:vert
        #pragma target 3.5
        #include "UnityPBSLighting.cginc"

        float _Ior;  // Refractive index of the body
        float _Depth;  // How far the image lies below the surface
        float2 _UvPerUnit;  // How far the texture coordinates move for one world unit along T and along B
        float4 _Tint;  // Multiplies the texture
        float _Metalness;  // 0 = not a metal, 1 = metal
        float _SurfaceRoughness;  // 0 = a mirror, 1 = chalk

        sampler2D _BaseColorTexture;

        struct Surface {
            float3 albedo;
            float metallic;
            float roughness;
        };

        static const float FLAT_FRAME = 0.01;

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

        // Everything about the surface that does not depend on a light.
        Surface evaluate_surface(float2 uv, float3 V, float3 T, float3 B, float3 N) {
            uv = parallax_refracted(uv, V, T, B, N);
            float3 albedo;
            float alpha;
            base_color(uv, albedo, alpha);
            float metallic;
            float roughness;
            pbr_constants(metallic, roughness);
            Surface surface = { albedo, metallic, roughness };
            return surface;
        }

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

        void vert(inout appdata_full v, out Input o) {
            UNITY_INITIALIZE_OUTPUT(Input, o);
            o.texcoord = v.texcoord.xy;
        }

        void surf(Input IN, inout SurfaceOutputStandard o) {
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
        }
        ENDCG
    }
    FallBack "Diffuse"
}

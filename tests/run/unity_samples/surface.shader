// A surface shader with a lighting model of its own: what the unity compiler must be able to take.
Shader "sssgen/Samples/Surface"
{
    Properties
    {
        _BaseMap ("Base map", 2D) = "white" {}
        [Normal] _NormalMap ("Normal map", 2D) = "bump" {}
        [NoScaleOffset] _Volume ("Volume", 3D) = "" {}
        _BaseColor ("Base colour", Color) = (1, 1, 1, 1)
        _Sharpness ("Sharpness", Range(0.5, 16)) = 4
        _Strength ("Strength", Float) = 1.5
    }
    SubShader
    {
        Tags { "RenderType" = "Opaque" }
        CGPROGRAM
        #pragma surface shade Backlit fullforwardshadows
        #pragma target 3.0
        #include "UnityPBSLighting.cginc"

        sampler2D _BaseMap;
        sampler2D _NormalMap;
        sampler3D _Volume;
        float4 _BaseColor;
        float _Sharpness;
        float _Strength;

        struct Input
        {
            float2 uv_BaseMap;
            float3 worldPos;
            float3 viewDir;
            INTERNAL_DATA
        };

        struct SurfaceOutputBacklit
        {
            fixed3 Albedo;
            float3 Normal;
            half3 Emission;
            half Metallic;
            half Smoothness;
            half Occlusion;
            fixed Alpha;
            half3 Through;
        };

        half4 LightingBacklit(SurfaceOutputBacklit s, half3 viewDir, UnityGI gi)
        {
            SurfaceOutputStandard standard;
            UNITY_INITIALIZE_OUTPUT(SurfaceOutputStandard, standard);
            standard.Albedo = s.Albedo;
            standard.Normal = s.Normal;
            standard.Emission = s.Emission;
            standard.Metallic = s.Metallic;
            standard.Smoothness = s.Smoothness;
            standard.Occlusion = s.Occlusion;
            standard.Alpha = s.Alpha;
            half4 lit = LightingStandard(standard, viewDir, gi);
            float behind = saturate(dot(viewDir, -normalize(gi.light.dir + s.Normal)));
            lit.rgb += gi.light.color * s.Through * pow(max(behind, 1e-4), _Sharpness) * _Strength;
            return lit;
        }

        void LightingBacklit_GI(SurfaceOutputBacklit s, UnityGIInput data, inout UnityGI gi)
        {
            UNITY_GI(gi, s, data);
        }

        void shade(Input IN, inout SurfaceOutputBacklit o)
        {
            float4 base = tex2D(_BaseMap, IN.uv_BaseMap) * _BaseColor;
            o.Albedo = base.rgb;
            o.Normal = UnpackNormal(tex2D(_NormalMap, IN.uv_BaseMap));
            o.Through = tex3D(_Volume, IN.worldPos).rgb + tex2Dlod(_BaseMap, float4(IN.uv_BaseMap, 0.0, 2.0)).rgb
                + tex2Dgrad(_BaseMap, IN.uv_BaseMap, ddx(IN.uv_BaseMap), ddy(IN.uv_BaseMap)).rgb
                + WorldNormalVector(IN, o.Normal);
            o.Metallic = 0.0;
            o.Smoothness = 0.5;
            o.Occlusion = 1.0;
            o.Alpha = base.a;
        }
        ENDCG
    }
    FallBack "Diffuse"
}

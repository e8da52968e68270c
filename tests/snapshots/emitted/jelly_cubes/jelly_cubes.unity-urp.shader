// Jelly cubes: Two jelly cubes on a floor, drawn from distance functions; their thin parts glow with
// the sky.
// Made by sssgen for Unity, Universal Render Pipeline. Change the material and emit it again rather than this file.
Shader "sssgen/Jelly cubes (URP)" {
    Properties {
        _OrbitRadius ("Orbit radius", Range(0.1, 100)) = 3
        _OrbitHeight ("Orbit height", Range(-100, 100)) = 2.5
        _LookAt ("Look at", Vector) = (0.65, 0.5, 0, 0)
        _Aspect ("Aspect", Range(0.1, 10)) = 1
        _FocalLength ("Focal length", Range(0.2, 20)) = 2
        _MaxDistance ("Max distance", Range(1, 1000)) = 50
        _Reach ("Reach", Range(0.01, 10)) = 0.4
        [HDR] _JellyColor ("Jelly color", Color) = (1, 0.5, 0, 1)
        _GlowStrength ("Glow strength", Range(0, 4)) = 0.6
        [HDR] _SkyColor ("Sky color", Color) = (0.67, 0.86, 0.98, 1)
        _KeyDirection ("Key direction", Vector) = (1, 1, 1, 0)
    }
    SubShader {
        Tags {
            "RenderPipeline" = "UniversalPipeline"
            "RenderType" = "Opaque"
            "Queue" = "Geometry"
        }
        Cull Off  // a raymarched scene: the mesh, a quad or a box around the camera, only says where it is drawn

        // Every pass sees the same material block, which the SRP batcher asks for.
        HLSLINCLUDE
        #include "Packages/com.unity.render-pipelines.universal/ShaderLibrary/Lighting.hlsl"

        CBUFFER_START(UnityPerMaterial)
            float _OrbitRadius;  // Radius of the orbit about the vertical axis
            float _OrbitHeight;  // Height of the orbit
            float3 _LookAt;  // What the camera looks at
            float _Aspect;  // Width of the image over its height
            float _FocalLength;  // Focal length, where the image is 2 high: the larger, the narrower the view
            float _MaxDistance;  // A ray that is longer than this meets nothing
            float _Reach;  // How deep the taps reach below the surface
            float3 _JellyColor;  // Colour of the cubes
            float _GlowStrength;  // Strength of the glow: 0.9 x 0.38667, since thinness was 0..0.38667 in the source
            float3 _SkyColor;  // Colour of the sky at the horizon; it turns white towards the zenith
            float3 _KeyDirection;  // Towards the key light; any length
        CBUFFER_END

        static const int MAX_STEPS = 200;
        static const float CUBE_SPACING = 1.45;
        static const float CUBE_HEIGHT = 0.48;
        static const float3 CUBES_HALF = float3(1.4322, 0.5, 0.7072);
        static const float COS_45 = 0.70710677;
        static const float HALF_SIZE = 0.5;
        static const float HIT_TOLERANCE = 0.001;
        static const float NOTHING = 0.004;
        static const float LEVEL = 1.0e-6;

        float3 mod_(float3 x, float y) {
            return x - y * floor(x / y);
        }

        // The direction of `x`; of a zero vector, 0.
        float3 safe_normalize(float3 x) {
            return x * rsqrt(max(dot(x, x), 1.0e-30));
        }

        // The direction in which the camera at `eye` sees the image point `uv` ((0, 0) to (1, 1), v up).
        float3 camera_ray(float3 eye, float2 uv) {
            float3 front = safe_normalize(_LookAt - eye);
            float3 right = safe_normalize(cross(front, float3(0.0, 1.0, 0.0)));
            float3 up = cross(right, front);
            float2 image = uv * 2.0 - 1.0;
            return safe_normalize(right * (image.x * _Aspect) + up * image.y + front * _FocalLength);
        }

        // A camera that circles the scene, one radian a second.
        void camera_orbit(float2 uv, float time, out float3 ray_origin, out float3 ray_direction) {
            ray_origin = float3(_OrbitRadius * cos(time), _OrbitHeight, _OrbitRadius * sin(time));
            ray_direction = camera_ray(ray_origin, uv);
        }

        // The signed distance to the ground, y = 0.
        float ground_plane(float3 p) {
            return p.y;
        }

        // A cube about the origin, turned by 45 degrees about the y axis.
        float turned_cube(float3 p) {
            float3 turned = float3((p.x - p.z) * COS_45, p.y, (p.x + p.z) * COS_45);
            float3 q = abs(turned) - HALF_SIZE;
            return length(max(q, 0.0)) + min(max(q.x, max(q.y, q.z)), 0.0);
        }

        // The two jelly cubes of 42yeah, without the floor: the body that light shines through.
        float jelly_cubes(float3 p) {
            // each is the other's mirror image in the plane between them, so the nearer one is all there is to ask
            float middle = 0.5 * CUBE_SPACING;
            return turned_cube(float3(abs(p.x - middle) - middle, p.y - CUBE_HEIGHT, p.z));
        }

        // The scene of 42yeah: two jelly cubes on the ground.
        float jelly_scene(float3 p) {
            float ground = ground_plane(p);
            // where the ground is nearer than their box, the cubes need no look
            float3 q = abs(p - float3(0.5 * CUBE_SPACING, CUBE_HEIGHT, 0.0)) - CUBES_HALF;
            if (max(q.x, max(q.y, q.z)) > ground) {
                return ground;
            }
            return min(jelly_cubes(p), ground);
        }

        // The gradient of the scene at `p`, from the four corners of a tetrahedron about it.
        float3 scene_normal(float3 p) {
            float2 e = HIT_TOLERANCE * float2(1.0, -1.0);
            float a = jelly_scene(p + e.xyy);
            float b = jelly_scene(p + e.yyx);
            float c = jelly_scene(p + e.yxy);
            float d = jelly_scene(p + e.xxx);
            // nearly equal numbers, whose differences are exact
            return safe_normalize(float3(a - b + (d - c), c - a + (d - b), b - a + (d - c)));
        }

        // Sphere tracing: draws a scene given as a distance function; where a ray meets nothing it returns false.
        bool raymarch(float3 ray_origin, float3 ray_direction, out float3 P, out float3 N, out float3 V) {
            float t = 0.0;
            bool hit = false;
            [loop]
            for (int i = 0; i < MAX_STEPS && t < _MaxDistance; i++) {
                float gap = jelly_scene(ray_origin + ray_direction * t);
                if (gap < HIT_TOLERANCE) {
                    hit = true;
                    break;
                }
                t += gap;
            }
            P = ray_origin + ray_direction * t;
            V = -ray_direction;
            N = V;
            if (hit) {
                N = scene_normal(P);
            }
            return hit;
        }

        // thinness_uniform in full, from a few taps: from the deepest one up, each halfway to where the sum would end.
        float thinness_traced(float3 P, float3 N) {
            float depth = _Reach;
            float here = clamp(depth + jelly_cubes(P - N * depth), 0.0, 2.0 * depth);
            // how much farther up it would be 0 if it went on in a straight line
            float way = 0.5 * here;
            float area = 0.0;
            // with nothing there, or nothing but emptiness, what lies farther up is known
            [loop]
            for (int i = 1; i < 4 && here > NOTHING * _Reach && here < 2.0 * depth; i++) {
                float stride = i + 1 < 4 ? 0.5 * way : way;
                float next = depth - stride;
                float there = max(min(next + jelly_cubes(P - N * next), min(here, 2.0 * next)), 0.0);
                area += stride * (here + there);
                depth = next;
                way = min(there / max(here - there, LEVEL) * stride, depth);
                here = there;
            }
            return min(0.5 * (area + way * here) / (_Reach * _Reach), 1.0);
        }

        // The colours of 42yeah's scene: jelly cubes on a faint checker floor, through which no light comes.
        void jelly_surface(float3 P, out float3 albedo, inout float th) {
            albedo = _JellyColor;
            if (ground_plane(P) < jelly_cubes(P)) {
                float3 tile = mod_(floor(P * 2.0), 2.0);
                albedo = (float3)(1.0 - 0.1 * abs(tile.x - tile.z));
                th = 0.0;
            }
        }

        // The light that comes from `direction`.
        float3 sky(float3 direction) {
            return lerp(_SkyColor, (float3)1.0, clamp(direction.y * 5.0, 0.0, 1.0));
        }

        // Thin parts show the sky behind them: light that needs no lamp.
        float3 sky_glow(float3 V, float th) {
            float3 mirrored = float3(-V.x, V.y, -V.z);
            return _GlowStrength * th * sky(mirrored);
        }

        // The sky behind a raymarched scene: the colour where a ray meets nothing.
        float3 sky_background(float3 ray_direction) {
            return sky(ray_direction);
        }

        // How much of the key light reaches `p`: the narrower the gap that it passes, the less.
        float soft_shadow(float3 p, float3 L) {
            float t = 0.001;
            float free = 1.0;
            // it only falls: below 0 there is no need to stop
            [loop]
            for (int i = 0; i < 25 && t < 4.0; i++) {
                float gap = jelly_scene(p + L * t);
                free = min(free, 20.0 * gap / t);
                t += clamp(gap, 0.001, 2.0);
            }
            return clamp(free, 0.0, 1.0);
        }

        // A small studio: key light with soft shadow, sky dome, bounce, light from behind, and what comes through.
        float3 studio(float3 P, float3 N, float3 albedo, float3 translucency) {
            float3 key = safe_normalize(_KeyDirection);
            float3 behind = float3(-key.x, 0.0, -key.z);
            float shadow = soft_shadow(P + N * 0.001, key);
            float3 light = (float3)0.2 * shadow;
            light += float3(0.82, 0.8, 0.82) * (max(dot(N, key), 0.0) * shadow);
            light += float3(0.26, 0.32, 0.334) * (0.2 + 0.8 * clamp(N.y, 0.0, 1.0));
            light += float3(0.3, 0.21, 0.23) * (0.2 + 0.8 * clamp(-N.y, 0.0, 1.0));
            light += float3(0.2, 0.21, 0.23) * max(dot(N, behind), 0.0);
            return albedo * (light + translucency);
        }

        // The colour of one fragment.
        float4 evaluate_color(float2 uv, float time) {
            float3 ray_origin;
            float3 ray_direction;
            camera_orbit(uv, time, ray_origin, ray_direction);
            float3 P;
            float3 N;
            float3 V;
            bool hit = raymarch(ray_origin, ray_direction, P, N, V);
            float3 color = sky_background(ray_direction);
            if (hit) {
                float thinness = thinness_traced(P, N);
                float3 albedo;
                jelly_surface(P, albedo, thinness);
                float3 translucency = sky_glow(V, thinness);
                color = studio(P, N, albedo, translucency);
            }
            return float4(color, 1.0);
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
            Name "ForwardUnlit"
            Tags { "LightMode" = "UniversalForwardOnly" }

            HLSLPROGRAM
            #pragma target 3.5
            #pragma vertex vert
            #pragma fragment frag
            #pragma multi_compile_fog
            #pragma multi_compile_instancing

            float4 frag(Varyings input) : SV_Target {
                UNITY_SETUP_INSTANCE_ID(input);
                UNITY_SETUP_STEREO_EYE_INDEX_POST_VERTEX(input);
                float4 color = evaluate_color(input.uv, _Time.y);
                color.rgb = MixFog(color.rgb, input.fogFactor);
                return color;
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

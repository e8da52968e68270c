// The lights of a body, and how they and the eye see it.
namespace Sssgen {
    using System.Collections.Generic;
    using UnityEngine;

    /// <summary>The lights of a body.</summary>
    public static class Lamps {
        /// <summary>The lights that are brightest at a box, at most `count`; `distant`: those from afar, if any.</summary>
        public static List<Light> Brightest(List<Light> lights, Bounds box, bool distant, int count) {
            var found = new List<Light>();
            var strengths = new List<float>();
            distant = distant && lights.Exists(light => IsLit(light, box) && light.type == LightType.Directional);
            foreach (Light light in lights) {
                if (IsLit(light, box) && (!distant || light.type == LightType.Directional)) {
                    float strength = Strength(light, box);
                    // behind those that are as bright, so that the order stays
                    int place = strengths.FindIndex(other => other < strength);
                    place = place < 0 ? found.Count : place;
                    found.Insert(place, light);
                    strengths.Insert(place, strength);
                }
            }
            return found.GetRange(0, Mathf.Min(count, found.Count));
        }

        private static bool IsLit(Light light, Bounds box) {
            return light != null && light.isActiveAndEnabled && Strength(light, box) > 0;
        }

        /// <summary>The irradiance at the middle of a box, as URP lets light fall off; 0 where no light reaches it.</summary>
        private static float Strength(Light light, Bounds box) {
            float strength = light.intensity * light.color.linear.maxColorComponent;
            if (light.type == LightType.Directional) {
                return strength;
            }
            Vector3 way = box.center - light.transform.position;
            float away = Mathf.Max(way.magnitude, 1e-3f);
            if (light.type == LightType.Spot) {
                float half = Mathf.Rad2Deg * Mathf.Asin(Mathf.Min(box.extents.magnitude / away, 1));
                if (Vector3.Angle(light.transform.forward, way) - half > 0.5f * light.spotAngle && half < 90) {
                    return 0;
                }
            } else if (light.type != LightType.Point) {
                return 0;
            }
            float share = Mathf.Pow(away / light.range, 4);
            return strength * Mathf.Pow(Mathf.Max(1 - share, 0), 2) / (away * away);
        }
    }

    /// <summary>How the eye or a light sees a body.</summary>
    public struct View {
        /// <summary>The width of a light's picture relative to the body.</summary>
        private const float Margin = 1.1f;
        /// <summary>More than any distance from the eye.</summary>
        private const float Far = 6e4f;

        public Matrix4x4 Camera;
        public Matrix4x4 Projection;
        public Vector3 Eye;
        /// <summary>Its product with a place is the distance from the plane in front of the eye or a light.</summary>
        public Vector4 Plane;
        /// <summary>The largest distance from this plane. A larger one would spread where a filter blends texels.</summary>
        public float End;

        public static View OfEye(Matrix4x4 camera, Matrix4x4 projection, Vector3 eye) {
            return new View { Camera = camera, Projection = projection, Eye = eye, Plane = -camera.GetRow(2), End = Far };
        }

        /// <summary>All of a box from a light; `distant`: as if the light were far away.</summary>
        public static View OfLight(Light light, Bounds box, bool distant) {
            if (light.type == LightType.Directional) {
                return FromAfar(light.transform.forward, box);
            }
            Vector3 way = box.center - light.transform.position;
            return distant ? FromAfar(way.normalized, box) : FromPoint(light.transform.position, way, box);
        }

        private static View FromAfar(Vector3 ahead, Bounds box) {
            Axes(ahead, out Vector3 right, out Vector3 up);
            float wide = 2 * Margin * Mathf.Max(Extent(box, right), Extent(box, up));
            float deep = Extent(box, ahead);
            Vector3 place = box.center - ahead * (deep + 0.1f * wide);
            float half = 0.5f * wide;
            float end = 2 * deep + 0.2f * wide;
            return new View(place, right, up, ahead, Matrix4x4.Ortho(-half, half, -half, half, 0, end), end);
        }

        private static View FromPoint(Vector3 place, Vector3 way, Bounds box) {
            float distance = Mathf.Max(way.magnitude, 1e-4f);
            Vector3 ahead = way.sqrMagnitude > 0 ? way.normalized : Vector3.forward;
            Axes(ahead, out Vector3 right, out Vector3 up);
            float slope = 0, near = distance, far = distance;
            for (int i = 0; i < 8; i++) {
                var corner = new Vector3((i & 1) * 2 - 1, (i & 2) - 1, (i & 4) / 2 - 1);
                Vector3 local = box.center + Vector3.Scale(box.extents, corner) - place;
                float depth = Vector3.Dot(local, ahead);
                near = Mathf.Min(near, depth);
                far = Mathf.Max(far, depth);
                // what is beside a lamp in the box is not seen
                float across = Mathf.Max(Mathf.Abs(Vector3.Dot(local, right)), Mathf.Abs(Vector3.Dot(local, up)));
                slope = Mathf.Max(slope, across / Mathf.Max(depth, 0.1f * distance));
            }
            near = Mathf.Max(0.99f * near, 0.01f * distance);
            float half = Margin * slope * near;
            float end = 1.01f * far;
            return new View(place, right, up, ahead, Matrix4x4.Frustum(-half, half, -half, half, near, end), end);
        }

        private View(Vector3 place, Vector3 right, Vector3 up, Vector3 ahead, Matrix4x4 projection, float end) {
            Camera = Matrix4x4.identity;
            Camera.SetRow(0, Row(right, place));
            Camera.SetRow(1, Row(up, place));
            Camera.SetRow(2, Row(-ahead, place));
            Projection = projection;
            Eye = place;
            Plane = Row(ahead, place);
            End = end;
        }

        /// <summary>World space to (u w, v w, distance from the plane, w) in a tile of the picture.</summary>
        public Matrix4x4 InTile(int tile, int columns) {
            Matrix4x4 clip = Projection * Camera;
            Vector4 w = clip.GetRow(3);
            var result = new Matrix4x4();
            result.SetRow(0, ((tile % columns + 0.5f) * w + 0.5f * clip.GetRow(0)) / columns);
            result.SetRow(1, ((tile / columns + 0.5f) * w + 0.5f * clip.GetRow(1)) / columns);
            result.SetRow(2, Plane);
            result.SetRow(3, w);
            return result;
        }

        private static Vector4 Row(Vector3 axis, Vector3 place) {
            return new Vector4(axis.x, axis.y, axis.z, -Vector3.Dot(axis, place));
        }

        private static float Extent(Bounds box, Vector3 axis) {
            Vector3 half = box.extents;
            return Mathf.Abs(axis.x) * half.x + Mathf.Abs(axis.y) * half.y + Mathf.Abs(axis.z) * half.z;
        }

        private static void Axes(Vector3 ahead, out Vector3 right, out Vector3 up) {
            float x = Mathf.Abs(ahead.x), y = Mathf.Abs(ahead.y), z = Mathf.Abs(ahead.z);
            Vector3 least = x <= y && x <= z ? Vector3.right : y <= z ? Vector3.up : Vector3.forward;
            right = Vector3.Cross(ahead, least).normalized;
            up = Vector3.Cross(ahead, right);
        }
    }
}

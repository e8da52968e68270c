// What TSL cannot have as it is, and what a reader wants to find again.

struct Hit { float distance; vec3 normal; int id; };
struct Scene { Hit nearest; mat3 frame; };

const float TAU = 6.2831853;
const float WEIGHTS[3] = float[3](0.25, 0.5, 0.25);
const mat3 FRAME = mat3(1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 10.0);

uniform float u_time;
float counter = 0.0;

/// The luminance of a linear colour.
float luma(vec3 color) {
    const vec3 weights = vec3(0.2126, 0.7152, 0.0722);  // Rec. 709
    return dot(color, weights);
}

// Its parameter is assigned to, its result is negated bits.
uint hash(uint x) {
    x ^= x >> 16u;
    x *= 0x7feb352du;
    return ~(x ^ (x >> 15u));
}

float guarded(float x, int n) {
    if (x < 0.0) return -1.0;
    float sum = 0.0;
    for (int i = 0; i < n; i++) {
        if (sum > 10.0) return sum;
        sum += x * float(i);
        if (i == 3) continue;
        sum *= 1.5;
    }
    return sum;
}

float trace(vec2 p, out vec2 q, inout float d) {
    q = p.yx * 2.0;
    d += 1.0;
    return d * q.x;
}

float traced(vec2 p) {
    vec2 place = vec2(0.0);
    float d = 0.5;
    float value = trace(p, place, d);
    place.yx += value;
    return place.x > 0.0 ? d : mod(place.y, 2.0);
}

void swap(inout float a, inout float b) { float kept = a; a = b; b = kept; }

float median(vec3 v) {
    if (v.x > v.y) swap(v.x, v.y);
    if (v.y > v.z) swap(v.y, v.z);
    if (v.x > v.y) swap(v.x, v.y);
    return v.y;
}

float bump() { counter += 1.5; return counter; }
float order(float x) { counter = x; float a = bump() + bump() * 2.0; return a + counter; }
float timed(float x) { return sin(x * TAU + u_time); }

int switched(int k) {
    int r = 0;
    switch (k) {
        case 0: r = 1; break;
        case 1: r = 5;
        case 2: r += 10; break;
        default: return -1;
    }
    return r;
}

float nested(int n) {
    float sum = 0.0;
    for (int i = 0; i < n; i++) {
        for (int j = i; j > -3; j -= 2) {
            if (j == 1) continue;
            sum += float(i * j);
            if (sum > 40.0) return -sum;
        }
    }
    return sum;
}

float grown(float x) {
    int rounds = 0;
    do { x *= 1.5; rounds++; if (x > 50.0) break; } while (rounds < 6 && x < 20.0);
    for (float t = 0.0; t < (rounds > 2 ? 3.0 : 1.5); t += 0.5) x += t;
    for (int i = 0, j = 5; i < j; i++, j--) x += float(i * j);
    return x;
}

Hit closer(Hit a, Hit b) { return a.distance < b.distance ? a : b; }

float seen(vec3 p) {
    Hit hits[2];
    hits[0] = Hit(p.x, p, 3);
    hits[1].distance = p.y;
    hits[1].normal = p.zyx;
    hits[1].id = 1;
    Hit hit = closer(hits[0], hits[1]);
    hit.normal.xy += 1.0;
    Scene scene;
    scene.nearest = hit;
    scene.frame = FRAME;
    scene.frame[1].x = 7.0;
    return (scene.frame * scene.nearest.normal).x + float(hit.id);
}

float total(float w[4], int n) {
    float sum = 0.0;
    for (int i = 0; i < 4; ++i) { if (i >= n) return sum; sum += w[i] * WEIGHTS[i & 1]; }
    return sum;
}

float summed(vec4 v, int k) {
    float w[4];
    w[0] = v.x; w[1] = v.y; w[2] = v.z; w[3] = v.w;
    w[k & 3] *= 2.0;
    return total(w, 3);
}

bool compared(vec3 a, ivec2 b) {
    bvec3 less = lessThan(a, vec3(0.5));
    return a == vec3(1.0) || b != ivec2(0) || (less.x ^^ all(not(less)));
}

int whole(int a, int b) { return a / max(b, 1) % 7 + (a << 2) - (a >> 1) + ~b + int(uint(a) & 0xffu) + int(uint(-1) >> 28); }
mat2 turned(mat2 m, float s) { m[0] /= s; m[1][0] = 2.0; return matrixCompMult(m, mat2(2.0)) + m / 2.0 + s; }
float hidden(float mix, float color) { float dot = mix * color; { float mix = dot + 1.0; dot += mix; } return dot; }

vec4 averaged(sampler2D map, vec2 p) {
    if (p.x < 0.0) return vec4(0.0);
    vec4 sum = texture(map, p);
    for (int i = 0; i < 3; i++) {
        if (i == 2 && p.y > 1.0) return sum;
        sum += textureLod(map, p + float(i), 0.0);
    }
    return sum * vec2(textureSize(map, 0)).x;
}

vec4 around(sampler3D volume, samplerCube sky, sampler2DArray layers, vec3 p) {
    return texture(volume, p) + texture(sky, p + 0.1) + texelFetch(volume, ivec3(0, 1, 0), 0) + texture(layers, vec3(p.xy, 1.0));
}

# Jelly cubes: Two jelly cubes on a floor, drawn from distance functions; their thin parts glow with
# the sky.
# Made by sssgen for NumPy (vectorised; the oracle). Change the material and emit it again rather than this file.

from sssgen.targets.numpy_runtime import *  # noqa: F403

MAX_STEPS = 200
CUBE_SPACING = 1.45
CUBE_HEIGHT = 0.48
COS_45 = 0.70710678
HALF_SIZE = 0.5
HIT_TOLERANCE = 0.001
NOTHING = 0.004
LEVEL = 1e-06

orbit_radius = 3.0  # Radius of the orbit about the vertical axis.
orbit_height = 2.5  # Height of the orbit.
look_at = vec(0.65, 0.5, 0.0)  # What the camera looks at.
aspect = 1.0  # Width of the image over its height.
focal_length = 2.0  # Focal length, where the image is 2 high: the larger, the narrower the view.
max_distance = 50.0  # A ray that is longer than this meets nothing.
reach = 0.4  # How deep the taps reach below the surface.
jelly_color = vec(1.0, 0.5, 0.0)  # Colour of the cubes.
glow_strength = 0.6  # Strength of the glow: 0.9 x 0.38667, since thinness was 0..0.38667 in the source.
sky_color = vec(0.67, 0.86, 0.98)  # Colour of the sky at the horizon; it turns white towards the zenith.
key_direction = vec(1.0, 1.0, 1.0)  # Towards the key light; any length.

def safe_normalize(x):
    """The direction of `x`; of a zero vector, 0."""
    return x * inversesqrt(max(dot(x, x), 1.0000000031710769e-30))

def camera_ray(eye, uv):
    """The direction in which the camera at `eye` sees the image point `uv` ((0, 0) to (1, 1), v up)."""
    front = safe_normalize(look_at - eye)
    right = safe_normalize(cross(front, vec(0.0, 1.0, 0.0)))
    up = cross(right, front)
    image = uv * 2.0 - 1.0
    return safe_normalize(right * (image[0] * aspect) + up * image[1] + front * focal_length)

def camera_orbit(uv, time):
    """A camera that circles the scene, one radian a second."""
    ray_origin = vec(orbit_radius * cos(time), orbit_height, orbit_radius * sin(time))
    ray_direction = camera_ray(ray_origin, uv)
    return ray_origin, ray_direction

def ground_plane(p):
    """The signed distance to the ground, y = 0."""
    return p[1]

def turned_cube(p):
    """A cube about the origin, turned by 45 degrees about the y axis."""
    turned = vec((p[0] - p[2]) * COS_45, p[1], (p[0] + p[2]) * COS_45)
    q = abs(turned) - HALF_SIZE
    return length(max(q, 0.0)) + min(max(q[0], max(q[1], q[2])), 0.0)

def jelly_cubes(p):
    """The two jelly cubes of 42yeah, without the floor: the body that light shines through."""
    # each is the other's mirror image in the plane between them, so the nearer one is all there is to ask
    middle = 0.5 * CUBE_SPACING
    return turned_cube(vec(abs(p[0] - middle) - middle, p[1] - CUBE_HEIGHT, p[2]))

def jelly_scene(p):
    """The scene of 42yeah: two jelly cubes on the ground."""
    CUBES_HALF = vec(1.4322, 0.5, 0.7072)
    ground = ground_plane(p)
    # where the ground is nearer than their box, the cubes need no look
    q = abs(p - vec(0.5 * CUBE_SPACING, CUBE_HEIGHT, 0.0)) - CUBES_HALF
    return select(max(q[0], max(q[1], q[2])) > ground, ground, min(jelly_cubes(p), ground))

def scene_normal(p):
    """The gradient of the scene at `p`, from the four corners of a tetrahedron about it."""
    e = HIT_TOLERANCE * vec(1.0, -1.0)
    a = jelly_scene(p + swizzle(e, "xyy"))
    b = jelly_scene(p + swizzle(e, "yyx"))
    c = jelly_scene(p + swizzle(e, "yxy"))
    d = jelly_scene(p + swizzle(e, "xxx"))
    # nearly equal numbers, whose differences are exact
    return safe_normalize(vec(a - b + (d - c), c - a + (d - b), b - a + (d - c)))

def raymarch(ray_origin, ray_direction):
    """Sphere tracing: draws a scene given as a distance function; where a ray meets nothing it returns false."""
    t = 0.0
    hit = False
    i = 0
    running = (i < MAX_STEPS) & (t < max_distance)
    while any(running):
        gap = jelly_scene(ray_origin + ray_direction * t)
        mask = running & (gap < HIT_TOLERANCE)
        hit = select(mask, True, hit)
        running = running & not_(mask)
        t = select(running, t + gap, t)
        i = i + 1
        running = running & ((i < MAX_STEPS) & (t < max_distance))
    P = ray_origin + ray_direction * t
    V = -ray_direction
    N = V
    N = select(hit, scene_normal(P), N)
    return hit, P, N, V

def thinness_traced(P, N):
    """thinness_uniform in full, from a few taps: from the deepest one up, each halfway to where the sum would end."""
    depth = reach
    here = clamp(depth + jelly_cubes(P - N * depth), 0.0, 2.0 * depth)
    # how much farther up it would be 0 if it went on in a straight line
    way = 0.5 * here
    area = 0.0
    # with nothing there, or nothing but emptiness, what lies farther up is known
    i = 1
    running = (i < 4) & (here > NOTHING * reach) & (here < 2.0 * depth)
    while any(running):
        stride = select(i + 1 < 4, 0.5 * way, way)
        next_ = depth - stride
        there = max(min(next_ + jelly_cubes(P - N * next_), min(here, 2.0 * next_)), 0.0)
        area = select(running, area + stride * (here + there), area)
        depth = select(running, next_, depth)
        way = select(running, min(there / max(here - there, LEVEL) * stride, depth), way)
        here = select(running, there, here)
        i = i + 1
        running = running & ((i < 4) & (here > NOTHING * reach) & (here < 2.0 * depth))
    return min(0.5 * (area + way * here) / (reach * reach), 1.0)

def jelly_surface(P, th):
    """The colours of 42yeah's scene: jelly cubes on a faint checker floor, through which no light comes."""
    albedo = jelly_color
    mask = ground_plane(P) < jelly_cubes(P)
    tile = mod(floor(P * 2.0), 2.0)
    albedo = select(mask, splat(3, 1.0 - 0.1 * abs(tile[0] - tile[2])), albedo)
    th = select(mask, 0.0, th)
    return albedo, th

def sky(direction):
    """The light that comes from `direction`."""
    return mix(sky_color, splat(3, 1.0), clamp(direction[1] * 5.0, 0.0, 1.0))

def sky_glow(V, th):
    """Thin parts show the sky behind them: light that needs no lamp."""
    mirrored = vec(-V[0], V[1], -V[2])
    return glow_strength * th * sky(mirrored)

def sky_background(ray_direction):
    """The sky behind a raymarched scene: the colour where a ray meets nothing."""
    return sky(ray_direction)

def soft_shadow(p, L):
    """How much of the key light reaches `p`: the narrower the gap that it passes, the less."""
    t = 0.001
    free = 1.0
    # it only falls: below 0 there is no need to stop
    i = 0
    running = (i < 25) & (t < 4.0)
    while any(running):
        gap = jelly_scene(p + L * t)
        free = select(running, min(free, 20.0 * gap / t), free)
        t = select(running, t + clamp(gap, 0.001, 2.0), t)
        i = i + 1
        running = running & ((i < 25) & (t < 4.0))
    return clamp(free, 0.0, 1.0)

def studio(P, N, albedo, translucency):
    """A small studio: key light with soft shadow, sky dome, bounce, light from behind, and what comes through."""
    key = safe_normalize(key_direction)
    behind = vec(-key[0], 0.0, -key[2])
    shadow = soft_shadow(P + N * 0.001, key)
    light = splat(3, 0.20000000298023224) * shadow
    light = light + vec(0.82, 0.8, 0.82) * (max(dot(N, key), 0.0) * shadow)
    light = light + vec(0.26, 0.32, 0.334) * (0.2 + 0.8 * clamp(N[1], 0.0, 1.0))
    light = light + vec(0.3, 0.21, 0.23) * (0.2 + 0.8 * clamp(-N[1], 0.0, 1.0))
    light = light + vec(0.2, 0.21, 0.23) * max(dot(N, behind), 0.0)
    return albedo * (light + translucency)

def gamma(color):
    """Encodes linear colour for a display of a plain gamma."""
    return pow(max(color, 0.0), splat(3, 0.45454543828964233))

def evaluate_color(uv, time):
    """The colour of one fragment."""
    ray_origin, ray_direction = camera_orbit(uv, time)
    hit, P, N, V = raymarch(ray_origin, ray_direction)
    color = sky_background(ray_direction)
    thinness = thinness_traced(P, N)
    albedo, thinness = jelly_surface(P, thinness)
    translucency = sky_glow(V, thinness)
    color = select(hit, studio(P, N, albedo, translucency), color)
    color = gamma(color)
    return vec(color, 1.0)

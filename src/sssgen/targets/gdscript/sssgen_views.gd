## The distance from the eye, or from a plane that touches a ball on the side of the camera, of what is behind the surface
## before; 0 in front of the plane.
const DISTANCE := "shader_type spatial;
render_mode unshaded, fog_disabled, shadows_disabled, cull_%s;
uniform vec4 ball;
uniform float bias;
uniform float margin;
uniform sampler2D before : filter_nearest, repeat_disable;

// The nearest half float, and a bit more, so that it stays the same where it is cut off and where it is rounded.
float half(float x) {
    float unit = exp2(floor(log2(max(x, 0.0001))) - 10.0);
    return (round(x / unit) + 0.25) * unit;
}

// What ALBEDO takes for a number to be stored: the Compatibility renderer decodes it with a cubic polynomial, and encodes
// it with a power.
float stored(float x) {
#if CURRENT_RENDERER == RENDERER_COMPATIBILITY
    float light = pow((x + 0.055) / 1.055, 2.4);
    float root = pow(light / 0.305306011, 1.0 / 3.0);
    for (int i = 0; i < 8; i++) {
        float excess = root * (root * (root * 0.305306011 + 0.682171111) + 0.012522878) - light;
        root -= excess / (root * (root * 0.915918033 + 1.364342222) + 0.012522878);
    }
    return root;
#else
    return x;
#endif
}

void fragment() {
    float distant = -(VIEW_MATRIX * vec4(ball.xyz, 1.0)).z;
    float plane = max(distant - ball.w, 0.001 * distant); // as Ball.plane
    float away = ball.w > 0.0 ? max(-VERTEX.z - plane - bias, 0.0) : length(VERTEX);
    if (margin > 0.0 && away < textureLod(before, SCREEN_UV, 0.0).r + margin) {
        discard;
    }
    ALBEDO = vec3(stored(half(away)));
}
"

## Several layers as the channels of one picture. The Compatibility renderer encodes light.
const PACKING := "shader_type canvas_item;
render_mode unshaded, blend_disabled;
uniform sampler2D layer_0 : filter_nearest, repeat_disable;
uniform sampler2D layer_1 : filter_nearest, repeat_disable;
uniform sampler2D layer_2 : filter_nearest, repeat_disable;
uniform sampler2D layer_3 : filter_nearest, repeat_disable;
uniform bool shows_light;

void fragment() {
    COLOR = vec4(textureLod(layer_0, UV, 0.0).r, textureLod(layer_1, UV, 0.0).g, textureLod(layer_2, UV, 0.0).b,
        textureLod(layer_3, UV, 0.0).r);
#if CURRENT_RENDERER == RENDERER_COMPATIBILITY
    if (shows_light) {
        COLOR.rgb = mix(vec3(0.0), pow((COLOR.rgb + 0.055) / 1.055, vec3(2.4)), greaterThan(COLOR.rgb, vec3(0.0)));
    }
#endif
}
"

## The ball around a body, in world space.
class Ball:
	var center: Vector3
	var radius := 1e-6

	func _init(body: GeometryInstance3D, place: Transform3D) -> void:
		var box := body.custom_aabb if body.custom_aabb.has_volume() else body.get_aabb()
		box = box.grow(body.extra_cull_margin)
		center = place * box.get_center()
		for i in 8:
			radius = maxf(radius, 1.02 * center.distance_to(place * box.get_endpoint(i)))

	## How far away the plane is from which distances count, where the centre is at a depth.
	func plane(depth: float) -> float:
		return maxf(depth - radius, 0.001 * depth)

	func as_vector() -> Vector4:
		return Vector4(center.x, center.y, center.z, radius)


## A viewport of half floats.
class FloatView extends SubViewport:
	static var shaders := {}

	func _init(above: Node) -> void:
		use_hdr_2d = true
		gui_disable_input = true
		above.add_child(self, false, Node.INTERNAL_MODE_BACK)

	func render(new_size: Vector2i) -> void:
		if size != new_size:
			size = new_size
		render_target_update_mode = SubViewport.UPDATE_ALWAYS

	static func material_of(text: String) -> ShaderMaterial:
		if text not in shaders:
			shaders[text] = Shader.new()
			shaders[text].code = text
		var material := ShaderMaterial.new()
		material.shader = shaders[text]
		return material


## What one camera sees, in a picture that is `empty` elsewhere.
class View extends FloatView:
	var camera := Camera3D.new()
	## How far away from the camera the plane is from which distances count.
	var plane: float
	## Whether what is empty is far away.
	var is_far: bool

	func _init(above: Node, empty: float) -> void:
		super(above)
		is_far = empty > 0.0
		camera.environment = Environment.new()
		camera.environment.background_mode = Environment.BG_COLOR
		camera.environment.background_color = Color(empty, empty, empty)
		# the Compatibility renderer keeps it for scenes that have no environment
		camera.environment.ambient_light_source = Environment.AMBIENT_SOURCE_DISABLED
		camera.physics_interpolation_mode = Node.PHYSICS_INTERPOLATION_MODE_OFF
		add_child(camera)
		camera.current = true

	## Gives the camera the view of the eye, of a ball.
	func aim_as(eye: Camera3D, ball: Ball) -> void:
		for property in ["projection", "fov", "size", "frustum_offset", "keep_aspect", "near", "far", "h_offset", "v_offset"]:
			camera.set(property, eye.get(property))
		camera.transform = eye.get_global_transform_interpolated().orthonormalized()
		plane = ball.plane(-(ball.center * camera.transform).z)

	## Lets the camera see all of a ball from a light; `distant`: as if it were far away.
	func aim_from(light: Light3D, distant: bool, ball: Ball) -> void:
		var place := light.get_global_transform_interpolated()
		var way := place.basis.z if light is DirectionalLight3D else place.origin - ball.center
		var afar := distant or light is DirectionalLight3D
		var distance := 2.0 * ball.radius if afar else maxf(way.length(), 1e-6)
		plane = ball.plane(distance)
		if afar:
			camera.set_orthogonal(2.0 * ball.radius, plane, distance + ball.radius)
		else:
			var half := minf(asin(minf(ball.radius / distance, 1.0)), 1.5)
			camera.set_perspective(rad_to_deg(2.0 * half), plane, distance + ball.radius)
		if is_far:
			# a larger distance than that of the end would spread where a filter blends texels
			var end := maxf(camera.far - plane, 1.0)
			var color := Color(end, end, end)
			# Compatibility, which has no such device, takes colours as they are
			var converts := RenderingServer.get_rendering_device() != null
			camera.environment.background_color = color.linear_to_srgb() if converts else color
		way = way.normalized()
		var up := Vector3.BACK if absf(way.y) > 0.99 else Vector3.UP
		camera.transform = Transform3D(Basis.looking_at(-way, up), ball.center + way * distance)

	## Takes a body as it is in this frame; without a radius of the ball, distances are those from the eye.
	func take(_body: GeometryInstance3D, _ball: Vector4, _margin: float) -> void:
		pass

	func render(new_size: Vector2i) -> void:
		camera.force_update_transform()
		super(new_size)

	## World space to (u w, v w, distance from the plane, w) in a tile of the picture.
	func view_in(tile: Vector2i, columns: int) -> Projection:
		var view := Projection(camera.transform.affine_inverse())
		var clip := camera.get_camera_projection() * view
		var result := Projection()
		for i in 4:
			var to: Vector4 = clip[i]
			var u := (tile.x + 0.5) * to.w + 0.5 * to.x
			var v := (tile.y + 0.5) * to.w - 0.5 * to.y
			result[i] = Vector4(u / columns, v / columns, -view[i].z, to.w)
		result[3].z -= plane # half floats are finer near it
		return result


## A layer of a body, in a world of its own.
class Layer extends View:
	var copy := Copy.new()
	var material: ShaderMaterial
	var is_behind: bool

	## `before`: the layer that this one is behind, or null.
	func _init(above: Node, back: bool, empty: float, before: Layer) -> void:
		super(above, empty)
		own_world_3d = true
		is_behind = before != null
		material = material_of(DISTANCE % ("front" if back else "back"))
		if is_behind:
			material.set_shader_parameter("before", before.get_texture())
		copy.material_override = material
		add_child(copy)

	func take(body: GeometryInstance3D, ball: Vector4, margin: float) -> void:
		copy.follow(body)
		copy.take_bounds(body)
		material.set_shader_parameter("ball", ball)
		material.set_shader_parameter("margin", margin if is_behind else 0.0)


## Several layers as the channels of one picture, with a tile for each light. A tile has the views of its `channels` by
## their names.
class Packing extends FloatView:
	func _init(above: Node, tiles: Array[Dictionary], channels: Array, columns: int) -> void:
		super(above)
		disable_3d = true
		transparent_bg = true # alpha has a layer
		for tile in tiles.size():
			var square := ColorRect.new()
			square.size = Vector2(SIDE, SIDE) / columns
			square.position = square.size * Vector2(tile % columns, floori(float(tile) / columns))
			square.material = material_of(PACKING)
			square.material.set_shader_parameter("shows_light", "light" in channels)
			for i in 4:
				var layer: View = tiles[tile][channels[mini(i, channels.size() - 1)]]
				square.material.set_shader_parameter("layer_%d" % i, layer.get_texture())
			add_child(square)

	func render(new_size: Vector2i) -> void:
		canvas_transform = Transform2D.IDENTITY.scaled(Vector2(new_size) / SIDE) # a new size of squares is a frame late
		super(new_size)

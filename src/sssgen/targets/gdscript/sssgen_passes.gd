# What Godot draws before a material: pictures of the body alone, or of all others that cast a shadow, as the eye or a
# light sees them, each in a SubViewport with a world of its own. A texture that the scene sets itself is not drawn.
extends Node

## The distance where there is no surface: it fits into half a float.
const FAR := 60000.0
## The width of a picture of what lights see, in texels: of one light, or of four in 2 × 2 tiles.
const SIDE := 1024
## A surface behind another is at least this share of the body's radius farther away: more than half floats round.
const MARGIN := 2e-3

## The distance from the eye, or from a plane that touches a ball on the side of the light, of what is behind the surface
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
    float distant = distance(CAMERA_POSITION_WORLD, ball.xyz);
    float plane = max(distant - ball.w, 0.001 * distant);
    float away = ball.w > 0.0 ? max(-VERTEX.z - plane - bias, 0.0) : length(VERTEX);
    if (margin > 0.0 && away < textureLod(before, SCREEN_UV, 0.0).r + margin) {
        discard;
    }
    ALBEDO = vec3(stored(half(away)));
}
"

## Several layers as the channels of one picture.
const PACKING := "shader_type canvas_item;
render_mode unshaded, blend_disabled;
uniform sampler2D layer_0 : filter_nearest, repeat_disable;
uniform sampler2D layer_1 : filter_nearest, repeat_disable;
uniform sampler2D layer_2 : filter_nearest, repeat_disable;
uniform sampler2D layer_3 : filter_nearest, repeat_disable;

void fragment() {
    COLOR = vec4(textureLod(layer_0, UV, 0.0).r, textureLod(layer_1, UV, 0.0).r, textureLod(layer_2, UV, 0.0).r,
        textureLod(layer_3, UV, 0.0).r);
}
"

## The body; without one it is the parent.
@export var body: GeometryInstance3D
## The camera whose view the pictures of the eye have; without one it is the current camera of the body's viewport.
@export var eye: Camera3D

## Material → the node whose pictures it has.
static var _owners := {}
var _casters: Casters
var _sky := SkyLight.new()
var _pictures: Array[Picture] = []
var _lights: Array[Light3D] = []
var _materials: Array[ShaderMaterial] = []


## Texture without which the picture is wrong → what to do.
func needed() -> Dictionary:
	return {}


## The passes of the material, as in its reflection: `name`, `seen_from`, `layers`, `empty`, `texture`, `views`, `lights`.
func passes() -> Array[Dictionary]:
	return []


func _enter_tree() -> void:
	if body == null:
		body = get_parent() as GeometryInstance3D
	if body == null:
		push_error("%s has no body: add it below one" % name)
		return
	_casters = Casters.new()
	for data in passes():
		if "light" in data["layers"]:
			push_warning("%s: Godot draws no %s; the diffuse reflection of the body stays Godot's" % [name, data["texture"]])
		else:
			_pictures.append(Picture.new(self, data, _casters))
	_lights.assign(get_tree().root.find_children("*", "Light3D", true, false))
	get_tree().node_added.connect(_note_light)
	for caster in get_tree().root.find_children("*", "GeometryInstance3D", true, false):
		_casters.note(caster)
	get_tree().node_added.connect(_casters.note)
	get_tree().node_removed.connect(_casters.forget)
	# after all scripts of the frame, so that no picture is a frame late
	RenderingServer.frame_pre_draw.connect(_draw)


func _exit_tree() -> void:
	if not RenderingServer.frame_pre_draw.is_connected(_draw):
		return
	RenderingServer.frame_pre_draw.disconnect(_draw)
	get_tree().node_added.disconnect(_note_light)
	get_tree().node_added.disconnect(_casters.note)
	get_tree().node_removed.disconnect(_casters.forget)
	for picture in _pictures:
		picture.release()
	for material in _materials:
		material.set_shader_parameter("sky_light_matrix", null)
		if _owners[material] == self:
			_owners.erase(material)
	_pictures.clear()
	_materials.clear()


func _note_light(node: Node) -> void:
	if node is Light3D and node not in _lights:
		_lights.append(node)


func _draw() -> void:
	var seen := is_instance_valid(body) and body.is_visible_in_tree()
	var camera: Camera3D
	if seen:
		camera = eye if is_instance_valid(eye) else body.get_viewport().get_camera_3d()
		seen = camera != null
		_find_materials()
		_sky.follow(camera)
		for material in _materials:
			material.set_shader_parameter("sky_light_matrix", _sky.matrix)
	for picture in _pictures:
		if seen:
			picture.draw(body, camera, _brightest)
		else:
			picture.rest()


## The materials of the body whose textures are drawn.
func _find_materials() -> void:
	for one in Copy.materials_of(body):
		var material := one as ShaderMaterial
		if material == null or material in _materials or not _reads(material.shader):
			continue
		_materials.append(material)
		var missing := needed()
		for texture: String in missing:
			if material.get_shader_parameter(texture) == null:
				push_warning("%s: '%s' is missing: %s" % [body.name, texture, missing[texture]])
		if material in _owners:
			push_warning("%s shares its material with another body: make it unique" % body.name)
			continue
		_owners[material] = self
		for picture in _pictures:
			picture.take(material)


func _reads(shader: Shader) -> bool:
	if shader == null:
		return false
	var names := shader.get_shader_uniform_list().map(func(uniform): return uniform["name"])
	return _pictures.any(func(picture): return picture.data["texture"] in names)


## The lights that are brightest at a ball, at most `count`; `distant`: those from afar, if there are any; `shadowed`:
## those that cast a shadow.
func _brightest(center: Vector3, distant: bool, shadowed: bool, count: int) -> Array[Light3D]:
	var found: Array[Light3D] = []
	var strengths := {}
	_lights = _lights.filter(func(light): return is_instance_valid(light))
	for light in _lights:
		if not light.is_visible_in_tree() or light.get_world_3d() != body.get_world_3d():
			continue
		if light.light_negative or not (light.light_cull_mask & body.layers) or (shadowed and not light.shadow_enabled):
			continue
		var color := light.light_color.srgb_to_linear()
		var strength := light.light_energy * maxf(color.r, maxf(color.g, color.b))
		if light is DirectionalLight3D:
			strength *= float(light.sky_mode != DirectionalLight3D.SKY_MODE_SKY_ONLY)
		else:
			strength *= _fall(light, center)
		if strength > 0.0:
			found.append(light)
			strengths[light] = strength
	if distant and found.any(func(light): return light is DirectionalLight3D):
		found = found.filter(func(light): return light is DirectionalLight3D)
	found.sort_custom(func(a, b): return strengths[a] > strengths[b])
	return found.slice(0, count)


## The share of a near light that its distance leaves, as Godot has it.
func _fall(light: Light3D, center: Vector3) -> float:
	var away := maxf(light.global_position.distance_to(center), 1e-3)
	var kind := "spot" if light is SpotLight3D else "omni"
	var reach: float = light.get(kind + "_range")
	return pow(maxf(1.0 - pow(away / reach, 4.0), 0.0), 2.0) * pow(away, -light.get(kind + "_attenuation"))


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

	func as_vector() -> Vector4:
		return Vector4(center.x, center.y, center.z, radius)


## A viewport of half floats.
class FloatView extends SubViewport:
	static var shaders := {}

	func _init(above: Node) -> void:
		use_hdr_2d = true
		gui_disable_input = true
		above.add_child(self, false, Node.INTERNAL_MODE_BACK)

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

	func _init(above: Node, empty: float) -> void:
		super(above)
		camera.environment = Environment.new()
		camera.environment.background_mode = Environment.BG_COLOR
		camera.environment.background_color = Color(empty, empty, empty)
		# the Compatibility renderer keeps it for scenes that have no environment
		camera.environment.ambient_light_source = Environment.AMBIENT_SOURCE_DISABLED
		camera.physics_interpolation_mode = Node.PHYSICS_INTERPOLATION_MODE_OFF
		add_child(camera)
		camera.current = true

	## Gives the camera the view of the eye.
	func aim_as(eye: Camera3D) -> void:
		for property in ["projection", "fov", "size", "frustum_offset", "keep_aspect", "near", "far", "h_offset", "v_offset"]:
			camera.set(property, eye.get(property))
		camera.transform = eye.get_global_transform_interpolated().orthonormalized()

	## Lets the camera see all of a ball from a light; `distant`: as if it were far away.
	func aim_from(light: Light3D, distant: bool, ball: Ball) -> void:
		var place := light.get_global_transform_interpolated()
		var way := place.basis.z if light is DirectionalLight3D else place.origin - ball.center
		var afar := distant or light is DirectionalLight3D
		var distance := 2.0 * ball.radius if afar else maxf(way.length(), 1e-6)
		var near := maxf(distance - ball.radius, 0.001 * distance)
		if afar:
			camera.set_orthogonal(2.0 * ball.radius, near, distance + ball.radius)
		else:
			var half := minf(asin(minf(ball.radius / distance, 1.0)), 1.5)
			camera.set_perspective(rad_to_deg(2.0 * half), near, distance + ball.radius)
		way = way.normalized()
		var up := Vector3.BACK if absf(way.y) > 0.99 else Vector3.UP
		camera.transform = Transform3D(Basis.looking_at(-way, up), ball.center + way * distance)

	func render(new_size: Vector2i) -> void:
		camera.force_update_transform()
		if size != new_size:
			size = new_size
		render_target_update_mode = SubViewport.UPDATE_ALWAYS

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
		result[3].z -= camera.near # the plane: half floats are finer near it
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

	## Takes a body as it is in this frame; without a radius of the ball, its distances from the eye.
	func take(body: GeometryInstance3D, ball: Vector4, margin: float) -> void:
		copy.follow(body)
		copy.take_bounds(body)
		material.set_shader_parameter("ball", ball)
		material.set_shader_parameter("margin", margin if is_behind else 0.0)


## Several layers as the channels of one picture, with a tile for each light.
class Packing extends FloatView:
	func _init(above: Node, tiles: Array[Array], columns: int) -> void:
		super(above)
		disable_3d = true
		transparent_bg = true # alpha has a layer
		size = Vector2i(SIDE, SIDE)
		for tile in tiles.size():
			var square := ColorRect.new()
			square.size = Vector2(SIDE, SIDE) / columns
			square.position = square.size * Vector2(tile % columns, floori(float(tile) / columns))
			square.material = material_of(PACKING)
			for i in 4:
				var layer: View = tiles[tile][mini(i, tiles[tile].size() - 1)]
				square.material.set_shader_parameter("layer_%d" % i, layer.get_texture())
			add_child(square)


## A pass: the layers that it draws for each light, and the picture that they make. The eye is one light here.
class Picture:
	## The textures of all pictures: a copy of a material has those of the other one.
	static var drawn := {}
	var data: Dictionary
	var users: Array[ShaderMaterial] = []
	var tiles: Array[Array] = []
	var columns := 1
	var packing: Packing
	var casters: Casters

	func _init(above: Node, of_pass: Dictionary, of_casters: Casters) -> void:
		data = of_pass
		casters = of_casters
		columns = 2 if data["views"].size() > 1 else 1
		for tile in maxi(data["views"].size(), 1):
			tiles.append(_layers(above))
		if tiles.size() > 1 or tiles[0].size() > 1:
			packing = Packing.new(above, tiles, columns)
		drawn[view().get_texture()] = true

	func _layers(above: Node) -> Array:
		var layers: Array[View] = []
		var empty := FAR if data["empty"] == "far" else 0.0
		for layer: String in data["layers"]:
			if layer.begins_with("other"):
				layers.append(OtherLayer.new(above, empty, casters))
				continue
			var back := layer.begins_with("exit")
			var place := int(layer.get_slice(" ", 1))
			var before: int = layers.size() - 1 if back else data["layers"].find("exit %d" % (place - 1))
			layers.append(Layer.new(above, back, empty, layers[before] if place > 1 else null))
		return layers

	## The viewport whose texture is the picture.
	func view() -> FloatView:
		return packing if packing != null else tiles[0][0]

	func take(material: ShaderMaterial) -> void:
		var given: Variant = material.get_shader_parameter(data["texture"])
		if given == null or given in drawn:
			material.set_shader_parameter(data["texture"], view().get_texture())
			users.append(material)

	func release() -> void:
		drawn.erase(view().get_texture())
		for material in users:
			for uniform: Variant in [data["texture"], data["lights"]] + data["views"]:
				if uniform != null:
					material.set_shader_parameter(uniform, null)
		for one in _views():
			one.queue_free()

	func rest() -> void:
		for one in _views():
			one.render_target_update_mode = SubViewport.UPDATE_DISABLED

	func _views() -> Array[FloatView]:
		var views: Array[FloatView] = []
		for layers in tiles:
			views.append_array(layers)
		if packing != null:
			views.append(packing)
		return views

	func draw(body: GeometryInstance3D, eye: Camera3D, brightest: Callable) -> void:
		rest()
		if users.is_empty():
			return
		var ball := Ball.new(body, body.get_global_transform_interpolated())
		var margin := MARGIN * ball.radius
		var by_eye: bool = data["seen_from"] == "eye"
		var distant: bool = data["seen_from"] == "distant light"
		var lights: Array[Light3D] = []
		if not by_eye:
			lights = brightest.call(ball.center, distant, data["seen_from"] == "each shadow", tiles.size())
		var size := Vector2i(SIDE, SIDE) / columns
		if by_eye:
			size = Vector2i(eye.get_viewport().get_texture().get_size())
		if tiles[0].any(func(view): return view is OtherLayer) and not lights.is_empty():
			casters.follow(body, ball, margin, eye)
		for tile in tiles.size():
			# a view of zeros shows nothing
			var shown := Projection(Vector4.ZERO, Vector4.ZERO, Vector4.ZERO, Vector4.ZERO)
			if by_eye or tile < lights.size():
				for one: View in tiles[tile]:
					if by_eye:
						one.aim_as(eye)
					else:
						one.aim_from(lights[tile], distant, ball)
					if one is Layer:
						one.take(body, Vector4.ZERO if by_eye else ball.as_vector(), margin)
					one.render(size)
				shown = tiles[tile][0].view_in(Vector2i(tile % columns, floori(float(tile) / columns)), columns)
			if tile < data["views"].size():
				_give(data["views"][tile], shown)
		if data["lights"] != null:
			var facts := PackedVector4Array()
			for light in lights:
				facts.append_array(Casters.vectors_of(light))
			facts.resize(3 * tiles.size())
			_give(data["lights"], facts)
		if packing != null and (by_eye or not lights.is_empty()):
			packing.render_target_update_mode = SubViewport.UPDATE_ALWAYS

	func _give(uniform: String, value: Variant) -> void:
		for material in users:
			material.set_shader_parameter(uniform, value)

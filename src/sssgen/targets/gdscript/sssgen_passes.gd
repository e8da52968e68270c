# What Godot draws before a material: pictures of the body alone, or of all others that cast a shadow, as the eye or a
# light sees them, each in a SubViewport with a world of its own, and the light inside it. A texture that the scene sets itself
# is not drawn.
extends Node

## The distance where there is no surface: it fits into half a float.
const FAR := 60000.0
## The width of a picture of what lights see, in texels: of one light, or of four in 2 × 2 tiles.
const SIDE := 1024
## A surface behind another is at least this share of the body's radius farther away: more than half floats round.
const MARGIN := 2e-3

## The body; without one it is the parent.
@export var body: GeometryInstance3D
## The camera whose view the pictures of the eye have; without one it is the current camera of the body's viewport.
@export var eye: Camera3D
## The file of `sssgen bake fluence --relit`, beside which its JSON lies; without one it is the file that the material names,
## beside this script.
@export_file("*.bin") var inner_light_file := ""
## Whether a frame waits for the light inside the body; otherwise a body shows that of some frames before while a light moves.
@export var inner_light_waits := false

## Material → the node whose pictures it has.
static var _owners := {}
var _casters: Casters
var _sky := SkyLight.new()
var _pictures: Array[Pass] = []
var _lights: Array[Light3D] = []
var _materials: Array[ShaderMaterial] = []


## Texture without which the picture is wrong → what to do.
func needed() -> Dictionary:
	return {}


## The file of the light inside the body, as the material names it.
func light_file() -> String:
	return ""


## The passes of the material, as in its reflection: `name`, `seen_from`, `layers`, `empty`, `texture`, `views`, `lights`,
## `size`.
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
		if data["seen_from"] == "inside":
			_pictures.append(InnerLight.new(data, _light_file()))
		elif data["name"] == "scene_behind":
			_pictures.append(Behind.new(data))
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
			picture.draw(body, camera, self)
		else:
			picture.rest()


func _light_file() -> String:
	if inner_light_file != "":
		return inner_light_file
	var script: Script = get_script()
	return script.resource_path.get_base_dir().path_join(light_file().get_file())


func sky() -> SkyLight:
	return _sky


## The materials of the body whose textures are drawn.
func _find_materials() -> void:
	for one in Copy.materials_of(body):
		var material := one as ShaderMaterial
		if material == null or material in _materials or not _reads(material.shader):
			continue
		_materials.append(material)
		if material in _owners:
			push_warning("%s shares its material with another body: make it unique" % body.name)
			continue
		_owners[material] = self
		for picture in _pictures:
			picture.take(material)
		var missing := needed()
		for texture: String in missing:
			if material.get_shader_parameter(texture) == null:
				push_warning("%s: '%s' is missing: %s" % [body.name, texture, missing[texture]])


func _reads(shader: Shader) -> bool:
	if shader == null:
		return false
	var names := shader.get_shader_uniform_list().map(func(uniform): return uniform["name"])
	return _pictures.any(func(picture: Pass): return picture.is_read_by(names))


## The lights that shine on the body.
func lights_on_body() -> Array[Light3D]:
	_lights = _lights.filter(func(light): return is_instance_valid(light))
	return _lights.filter(func(light: Light3D) -> bool:
		if not light.is_visible_in_tree() or light.get_world_3d() != body.get_world_3d():
			return false
		var shines: bool = not light is DirectionalLight3D or light.sky_mode != DirectionalLight3D.SKY_MODE_SKY_ONLY
		return shines and light.light_cull_mask & body.layers != 0)


## The lights that are brightest at a ball, at most `count`; `distant`: those from afar, if there are any; `shadowed`:
## those that cast a shadow.
func brightest(center: Vector3, distant: bool, shadowed: bool, count: int) -> Array[Light3D]:
	var found: Array[Light3D] = []
	var strengths := {}
	for light in lights_on_body():
		if light.light_negative or (shadowed and not light.shadow_enabled):
			continue
		var color := light.light_color.srgb_to_linear()
		var strength := light.light_energy * maxf(color.r, maxf(color.g, color.b))
		if not light is DirectionalLight3D:
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


## A pass, and the materials that have its texture.
class Pass:
	## The textures of all passes: a copy of a material has those of the other one.
	static var drawn := {}
	var data: Dictionary
	var users: Array[ShaderMaterial] = []

	## What the pass draws; null where it cannot draw.
	func texture() -> Texture:
		return null

	## Whether a shader with uniforms of these names reads the picture.
	func is_read_by(names: Array) -> bool:
		return data["texture"] in names

	func take(material: ShaderMaterial) -> void:
		var given: Variant = material.get_shader_parameter(data["texture"])
		if given == null or given in drawn:
			material.set_shader_parameter(data["texture"], texture())
			users.append(material)

	func draw(_body: GeometryInstance3D, _eye: Camera3D, _scene: Node) -> void:
		pass

	func rest() -> void:
		pass

	func release() -> void:
		for material in users:
			for uniform: Variant in [data["texture"], data["lights"]] + data["views"]:
				if uniform != null:
					material.set_shader_parameter(uniform, null)

	func _give(uniform: String, value: Variant) -> void:
		for material in users:
			material.set_shader_parameter(uniform, value)


## A pass: the layers that it draws for each light, and the picture that they make. The eye is one light here.
class Picture extends Pass:
	## For each light its layers by their names.
	var tiles: Array[Dictionary] = []
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
			packing = Packing.new(above, tiles, data["layers"], columns)
		drawn[texture()] = true

	func _layers(above: Node) -> Dictionary:
		var layers := {}
		var empty := FAR if data["empty"] == "far" else 0.0
		for layer: String in data["layers"]:
			if layer in layers:
				continue
			if layer == "light":
				layers[layer] = LightLayer.new(above)
			elif layer.begins_with("other"):
				layers[layer] = OtherLayer.new(above, empty, casters)
			else:
				var back := layer.begins_with("exit")
				var place := int(layer.get_slice(" ", 1))
				var before := "entry %d" % place if back else "exit %d" % (place - 1)
				layers[layer] = Layer.new(above, back, empty, layers[before] if place > 1 else null)
		return layers

	## The viewport whose texture is the picture.
	func view() -> FloatView:
		return packing if packing != null else tiles[0].values()[0]

	func texture() -> Texture:
		return view().get_texture()

	func release() -> void:
		drawn.erase(texture())
		super()
		for one in _views():
			one.queue_free()

	func rest() -> void:
		for one in _views():
			one.render_target_update_mode = SubViewport.UPDATE_DISABLED

	func _views() -> Array[FloatView]:
		var views: Array[FloatView] = []
		for layers in tiles:
			views.append_array(layers.values())
		if packing != null:
			views.append(packing)
		return views

	func draw(body: GeometryInstance3D, eye: Camera3D, scene: Node) -> void:
		rest()
		if users.is_empty():
			return
		var ball := Ball.new(body, body.get_global_transform_interpolated())
		var margin := MARGIN * ball.radius
		var by_eye: bool = data["seen_from"] == "eye"
		var from_plane: bool = not by_eye or not data["views"].is_empty()
		var distant: bool = data["seen_from"] == "distant light"
		var lights: Array[Light3D] = []
		if not by_eye:
			lights = scene.brightest(ball.center, distant, data["seen_from"] == "each shadow", tiles.size())
		var size := Vector2i(SIDE, SIDE) / columns
		if by_eye:
			size = Vector2i(eye.get_viewport().get_texture().get_size())
		if "other 1" in tiles[0] and not lights.is_empty():
			casters.follow(body, ball, margin, eye)
		for tile in tiles.size():
			# a view of zeros shows nothing
			var shown := Projection(Vector4.ZERO, Vector4.ZERO, Vector4.ZERO, Vector4.ZERO)
			if by_eye or tile < lights.size():
				for one: View in tiles[tile].values():
					if by_eye:
						one.aim_as(eye, ball)
					else:
						one.aim_from(lights[tile], distant, ball)
					one.take(body, ball.as_vector() if from_plane else Vector4.ZERO, margin)
					one.render(size)
				var place := Vector2i(tile % columns, floori(float(tile) / columns))
				shown = tiles[tile].values()[0].view_in(place, columns)
			if tile < data["views"].size():
				_give(data["views"][tile], shown)
		if data["lights"] != null:
			var facts := PackedVector4Array()
			for light in lights:
				facts.append_array(Casters.vectors_of(light))
			facts.resize(3 * tiles.size())
			_give(data["lights"], facts)
		if packing != null and (by_eye or not lights.is_empty()):
			packing.render(columns * size)

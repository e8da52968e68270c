## A body as it is in this frame, in another world.
class Copy extends GeometryInstance3D:
	var skeleton: RID

	func _init() -> void:
		physics_interpolation_mode = Node.PHYSICS_INTERPOLATION_MODE_OFF

	func follow(body: GeometryInstance3D) -> void:
		if get_base() != body.get_base():
			set_base(body.get_base())
			skeleton = RID()
			take_bounds(body)
		var place := body.get_global_transform_interpolated()
		if transform != place:
			transform = place
			force_update_transform()
		var mesh := body as MeshInstance3D
		if mesh == null:
			return
		var skin := mesh.get_skin_reference()
		var bones := skin.get_skeleton() if skin != null else RID()
		if skeleton != bones:
			skeleton = bones
			RenderingServer.instance_attach_skeleton(get_instance(), bones)
		for i in mesh.get_blend_shape_count():
			RenderingServer.instance_set_blend_shape_weight(get_instance(), i, mesh.get_blend_shape_value(i))

	func take_bounds(body: GeometryInstance3D) -> void:
		custom_aabb = body.custom_aabb
		extra_cull_margin = body.extra_cull_margin
		lod_bias = body.lod_bias

	static func materials_of(body: GeometryInstance3D) -> Array[Material]:
		var found: Array[Material] = [body.material_override, body.material_overlay]
		if body is MeshInstance3D and body.mesh != null:
			for i in body.mesh.get_surface_count():
				found.append(body.get_active_material(i))
		elif body is MultiMeshInstance3D and body.multimesh != null and body.multimesh.mesh != null:
			for i in body.multimesh.mesh.get_surface_count():
				found.append(body.multimesh.mesh.surface_get_material(i))
		return found.filter(func(material): return material != null)


## Copies of all bodies but one that cast a shadow, in a world of their own, which has all lights' views of them.
class Casters:
	var world := World3D.new()
	## The node that has the copies.
	var above: Node
	## Caster → its copy, or null.
	var copies := {}
	## What a caster is drawn with: whether its back faces cast a shadow → material.
	var materials := {false: FloatView.material_of(DISTANCE % "back"), true: FloatView.material_of(DISTANCE % "disabled")}
	## The layers of bodies that the eye sees: others cast no shadow.
	var seen: int
	## The radius of a ball about the body that has all casters.
	var reach: float

	func note(node: Node) -> void:
		if node is GeometryInstance3D and not node is Copy:
			copies.get_or_add(node)

	func forget(node: Node) -> void:
		if copies.get(node) != null:
			copies[node].queue_free()
		copies.erase(node)

	## Puts the copies where the casters are.
	func follow(body: GeometryInstance3D, ball: Ball, bias: float, eye: Camera3D) -> void:
		var here := body.get_world_3d()
		seen = eye.cull_mask
		reach = ball.radius
		for material: ShaderMaterial in materials.values():
			material.set_shader_parameter("ball", ball.as_vector())
			material.set_shader_parameter("bias", bias)
		for caster: GeometryInstance3D in copies:
			var casts := caster != body and caster.is_visible_in_tree() and caster.get_world_3d() == here
			casts = casts and caster.cast_shadow != GeometryInstance3D.SHADOW_CASTING_SETTING_OFF
			if copies[caster] == null and casts:
				copies[caster] = Copy.new()
				above.add_child(copies[caster])
			var copy: Copy = copies[caster]
			if copy == null:
				continue
			if casts and copy.get_base() != caster.get_base():
				_take_materials(caster, copy)
			copy.visible = casts and copy.material_override != null
			if copy.visible:
				copy.layers = caster.layers
				copy.follow(caster)
				var box := copy.transform * caster.get_aabb()
				reach = maxf(reach, box.get_center().distance_to(ball.center) + 0.5 * box.size.length())

	## A copy of a body whose materials are all transparent has no material: it casts no shadow.
	func _take_materials(caster: GeometryInstance3D, copy: Copy) -> void:
		var found := Copy.materials_of(caster)
		var both_sides := caster.cast_shadow == GeometryInstance3D.SHADOW_CASTING_SETTING_DOUBLE_SIDED
		both_sides = both_sides or not found.all(culls_back)
		var casts := found.is_empty() or not found.all(_is_transparent)
		copy.material_override = materials[both_sides] if casts else null

	static func culls_back(material: Material) -> bool:
		if material is ShaderMaterial:
			return material.shader == null or not material.shader.code.contains("cull_")
		return not material is BaseMaterial3D or material.cull_mode == BaseMaterial3D.CULL_BACK

	static func _is_transparent(material: Material) -> bool:
		if material is ShaderMaterial and material.shader != null:
			var code: String = material.shader.code
			return code.contains("ALPHA =") and not code.contains("ALPHA_SCISSOR") and not code.contains("depth_prepass_alpha")
		return material is BaseMaterial3D and material.transparency == BaseMaterial3D.TRANSPARENCY_ALPHA

	## A light for the shader: its place and 1, or the way to it and 0; the axis and the cosine of its cone; 1 / its range,
	## the exponents of its falloff and of its cone's, and how dark its shadow is.
	static func vectors_of(light: Light3D) -> PackedVector4Array:
		var place := light.get_global_transform_interpolated()
		var way := place.basis.z.normalized()
		var opacity := light.shadow_opacity
		if light is DirectionalLight3D:
			return [_with(way, 0.0), Vector4(0.0, 0.0, 0.0, -1.0), Vector4(0.0, 0.0, 100.0, opacity)]
		if light is SpotLight3D:
			return [_with(place.origin, 1.0), _with(-way, cos(deg_to_rad(light.spot_angle))),
				Vector4(1.0 / light.spot_range, light.spot_attenuation, 1.0 / light.spot_angle_attenuation, opacity)]
		return [_with(place.origin, 1.0), Vector4(0.0, 0.0, 0.0, -1.0),
			Vector4(1.0 / light.omni_range, light.omni_attenuation, 100.0, opacity)]

	static func _with(xyz: Vector3, w: float) -> Vector4:
		return Vector4(xyz.x, xyz.y, xyz.z, w)


## What a light sees of these copies.
class OtherLayer extends View:
	var casters: Casters

	func _init(parent: Node, empty: float, of_casters: Casters) -> void:
		super(parent, empty)
		casters = of_casters
		world_3d = casters.world
		if casters.above == null:
			casters.above = self

	## The same view as that of the body, from the light on.
	func aim_from(light: Light3D, distant: bool, ball: Ball) -> void:
		super(light, distant, ball)
		if camera.projection == Camera3D.PROJECTION_ORTHOGONAL:
			camera.position += camera.basis.z * casters.reach
			camera.far += casters.reach
		camera.near = 1e-3 * camera.far
		var mask: Variant = light.get("shadow_caster_mask") # from Godot 4.4 on
		camera.cull_mask = casters.seen & (mask if mask != null else casters.seen)

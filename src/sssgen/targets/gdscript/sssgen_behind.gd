## What is behind a clear body: Godot has the picture of the screen, and the material must know where a point is in it.
class Behind extends Pass:
	func _init(of_pass: Dictionary) -> void:
		data = of_pass

	func is_read_by(names: Array) -> bool:
		return data["views"][0] in names

	func take(material: ShaderMaterial) -> void:
		users.append(material)

	func draw(_body: GeometryInstance3D, eye: Camera3D, _scene: Node) -> void:
		var clip := eye.get_camera_projection() * Projection(eye.get_camera_transform().affine_inverse())
		var shown := Projection()
		for i in 4:
			var to: Vector4 = clip[i]
			shown[i] = Vector4(0.5 * (to.w + to.x), 0.5 * (to.w - to.y), to.z, to.w)
		var size := eye.get_viewport().get_texture().get_size()
		_give(data["views"][0], shown)
		_give(data["size"], floorf(log(maxf(size.x, size.y)) / log(2.0)))

	func release() -> void:
		_give(data["views"][0], null)

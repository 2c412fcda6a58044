wall = 2;

module box(w) {
	cube([w, w, wall]);
}
box(10);

// Where and when to hit: the whole of Pongeye in one loop over pictures from any camera.
//
//     cc hit.c $(pkg-config --cflags --libs pongeye) -o hit && ./hit rig.toml <pairs
//
// Standard input: stereo pairs of 640 x 480 grey pictures, left then right, 110 pairs a second.
#include <pongeye.h>
#include <stdio.h>

int main(int argc, char **argv)
{
	static uint8_t pixels[2][480 * 640];
	const pong_image left = {pixels[0], 640, 480, 640}, right = {pixels[1], 640, 480, 640};
	pong_rig rig;
	pong_settings settings;
	pong_error error = {""};
	pong_settings_defaults(PONG_BEST, &settings);
	pong_eye *eye = NULL;
	if (pong_rig_load(argc > 1 ? argv[1] : "rig.toml", &rig, &error) > 0)
		eye = pong_eye_new(&rig, &settings, &error);
	for (int64_t frame = 0; eye && fread(pixels, sizeof pixels, 1, stdin) == 1; frame++) {
		pong_sight sight;
		if (pong_eye_push(eye, frame * 1000000 / 110, frame, &left, &right, &sight, &error) < 0)
			break;
		if (sight.has_prediction && sight.prediction.has_hit)
			printf("hit at x %+.3f m, y %.3f m in %.0f ms\n", sight.prediction.hit.position[0],
			       sight.prediction.hit.position[1],
			       (double)(sight.prediction.hit.utime - sight.ball.utime) / 1000);
	}
	if (error.text[0])
		fprintf(stderr, "%s\n", error.text);
	pong_eye_free(eye);
	return error.text[0] != '\0';
}

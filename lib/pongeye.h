/* pongeye.h - the eyes of a ping-pong robot.
 *
 * Two synchronised cameras in; the ball's position, and where and when it can be hit, out. A stereo pair flows
 * through these stages, and this header is in their order:
 *
 *     frame pair > region > detect > locate > reconstruct > track > predict
 *                    ^                                         |
 *                    '----------------- window <---------------'
 *
 * Most programs want no more than the eye at the end of this header, which joins the stages:
 *
 *     pong_rig rig;
 *     pong_error error;
 *     if (pong_rig_load("rig.toml", &rig, &error) < 0)
 *         fprintf(stderr, "%s\n", error.text);
 *     pong_settings settings;
 *     pong_settings_defaults(PONG_BEST, &settings);
 *     pong_eye *eye = pong_eye_new(&rig, &settings, &error);
 *     pong_sight sight;
 *     while (next_pair(&utime, &frame, &left, &right)) {
 *         pong_eye_push(eye, utime, frame, &left, &right, &sight, &error);
 *         if (sight.has_prediction && sight.prediction.has_hit)
 *             swing_at(sight.prediction.hit.position, sight.prediction.hit.utime);
 *     }
 *     pong_eye_free(eye);
 *
 * Conventions (docs/conventions.md says more)
 * - Table frame: origin in the middle of the robot's end line, on the playing surface; x to the robot's left, y up,
 *   z along the table towards the opponent. A ball that rests on the table has y = 0.020.
 * - Metres, seconds, radians, pixels. Pixel (0, 0) is the centre of the top left pixel; u runs right, v down.
 * - utime: microseconds since the Unix epoch, of the middle of the exposure.
 * - Plain structs belong to the caller and hold no pointers to be freed. What has a _new has a _free, which takes NULL.
 * - Three kinds of failure, never mixed. A caller's bug (a NULL where none is allowed) asserts. The world's fault (a
 *   file, a wrong size) is a negative code, and one sentence in *error, which may be NULL. Absence ("no ball") is a
 *   normal answer, 0.
 * - The library never prints, exits, starts a thread or reads a clock. After the _new calls it allocates nothing.
 *   Any function may run in any thread; one object is for one thread at a time.
 */
#ifndef PONGEYE_H
#define PONGEYE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define PONG_VERSION "0.1.0"

#define PONG_API __attribute__((visibility("default")))

/* The version of the library that runs, as opposed to PONG_VERSION, the one that was compiled against. */
PONG_API const char *pong_version(void);

enum {
	PONG_NONE = 0,          /* nothing there: a normal answer */
	PONG_FOUND = 1,         /* found, or done */
	PONG_ERROR_FILE = -1,   /* a file cannot be read or written */
	PONG_ERROR_FORMAT = -2, /* a file or text says something that cannot be understood */
	PONG_ERROR_VALUE = -3,  /* a value is outside of what is possible */
	PONG_ERROR_MEMORY = -4, /* out of memory */
};

/* One sentence that says what is wrong and where: "rig.toml:12:5: left.P needs 12 numbers, has 11". */
typedef struct pong_error {
	char text[512];
} pong_error;

/* A grey picture, 8 bits a pixel, borrowed from the caller for the length of a call. */
typedef struct pong_image {
	const uint8_t *pixels; /* row 0 first */
	int width, height;     /* pixels */
	ptrdiff_t stride;      /* bytes from one row to the next */
} pong_image;

typedef enum pong_side { PONG_LEFT = 0, PONG_RIGHT = 1 } pong_side;

/* PONG_PAPER follows the published method to the letter; PONG_BEST is what measures best. */
typedef enum pong_profile { PONG_PAPER = 0, PONG_BEST = 1 } pong_profile;

/* --------------------------------------------------------------------------------------------------------------
 * Rig: the two cameras, the ball and the table, as rig.toml describes them
 */

/* A camera is its projection matrix: s [u v 1]' = P [x y z 1]' (paper, eq. 1), and a lens. */
typedef struct pong_camera {
	char id[64];          /* how capture finds it: address or GenICam id; empty if it has none */
	int width, height;    /* pixels */
	double P[3][4];       /* pixels from table frame, scaled so that w = depth in metres along the optical axis */
	double distortion[5]; /* OpenCV's k1 k2 p1 p2 k3, about the K that P contains; all zero: a perfect lens */
} pong_camera;

/* The ball and how it flies. */
typedef struct pong_ball_spec {
	double diameter;     /* m */
	double mass;         /* kg */
	double drag;         /* C in F = C rho S v^2 / 2 (paper, eq. 16) */
	double air_density;  /* rho, kg/m^3 */
	double bounce[3];    /* velocity after a bounce over velocity before it, x y z; y is negative (paper, eq. 23) */
	double drag_by_spin; /* what S, the speed of the ball's surface over that of its flight, adds to the drag's C */
	double magnus;       /* F = magnus spin x velocity / (1 + magnus_saturation S), kg */
	double magnus_saturation;
	double restitution; /* vertical speed after a bounce over that before it */
	double friction;    /* mu between ball and table */
	double grip; /* 0: the ball leaves the table rolling where friction suffices; above, its slip is turned over,
			as that of a gripping rubber ball is, by this part */
	double kick; /* standard deviation of what a bounce adds to the velocity along the table, m/s */
	double spin_sigma[3]; /* of the spin that players give to the ball about x, y, z, rad/s; its mean is 0 */
	/* Standard deviations of the coefficients above: from ball to ball, from day to day. */
	double drag_sigma, magnus_sigma, restitution_sigma, friction_sigma, grip_sigma;
} pong_ball_spec;

/* Where there is no table there is no bounce, and the whole image is searched. */
typedef struct pong_table {
	int present;
	double length, width; /* m */
	double net;           /* height of the net, m; 0: there is none */
	double height;        /* of the surface, as the cameras see it, m: 0 but for the errors of calibration, */
	double height_sigma;  /* whose standard deviation this is, m */
} pong_table;

typedef struct pong_rig {
	pong_ball_spec ball;
	pong_table table;
	double hit_z;          /* the plane on which the robot hits, m */
	pong_camera camera[2]; /* by pong_side */
} pong_rig;

/* Today's ball on today's table, the hit plane at its end, no cameras: enough to track and predict points. */
PONG_API void pong_rig_defaults(pong_rig *rig);

/* Read rig.toml. On an error *rig is unchanged.
 * Returns PONG_FOUND, PONG_ERROR_FILE, PONG_ERROR_FORMAT or PONG_ERROR_VALUE, with file, line and column in *error. */
PONG_API int pong_rig_load(const char *path, pong_rig *rig, pong_error *error);

/* The same of a file that may lack the cameras, which are not read: what tracking and predicting points needs. */
PONG_API int pong_rig_load_flight(const char *path, pong_rig *rig, pong_error *error);

/* As pong_rig_load, from text of any length; name stands for the file in errors. */
PONG_API int pong_rig_parse(const char *text, const char *name, pong_rig *rig, pong_error *error);

/* Write *rig as TOML text into text[capacity], always terminated. Returns the length that it takes (as snprintf does:
 * at capacity or above, the text was cut). What is written reads back to the same numbers. */
PONG_API int pong_rig_format(const pong_rig *rig, char *text, int capacity);

/* Project a point of the table frame, lens distortion included.
 * Returns PONG_FOUND, or PONG_NONE where the point is not in front of the camera. It may lie outside of the picture. */
PONG_API int pong_project(const pong_camera *camera, const double position[3], double uv[2]);

/* Take the lens distortion out of a pixel: where a perfect lens with the same P would have put it. */
PONG_API void pong_undistort(const pong_camera *camera, const double uv[2], double ideal_uv[2]);

/* The ray that a pixel sees: table frame, from the camera's centre along the unit vector direction, into the scene. */
PONG_API void pong_ray(const pong_camera *camera, const double uv[2], double centre[3], double direction[3]);

/* The diameter, in pixels, of a sphere of the given diameter (m) at a position; 0 behind the camera. */
PONG_API double pong_apparent_size(const pong_camera *camera, const double position[3], double diameter);

/* --------------------------------------------------------------------------------------------------------------
 * Calibrate: the two cameras from the corners of boards, and how far they are to be trusted (docs/calibrate.md)
 */

/* A board, or anything else with points at known places, as it stood in one pair of pictures. Its pose maps board frame
 * to table frame: X = pose [x y z 1]'. */
typedef struct pong_view {
	int placed;            /* whether it is known where it stood; if not, only its corners tell */
	double pose[3][4];     /* where it was placed, [R | t]; not read unless placed */
	double sigma_position; /* how well the board frame's origin was placed, standard deviation per axis, m */
	double sigma_angle;    /* how well it was turned, about each axis, rad */
	double sigma_shape;    /* how far its points lie from their stated places, per axis, m; 0: it is rigid */
} pong_view;

/* A point of a board, seen by one camera. */
typedef struct pong_corner {
	int view;        /* which view, from 0 */
	pong_side side;  /* the camera that saw it */
	int point;       /* which of the board's points, from 0: the same in both cameras */
	double board[3]; /* its place in the board frame, m; z = 0 or nearly: a board is flat */
	double uv[2];    /* px */
	double spread;   /* its noise over that of a board's corner; 0 stands for 1 */
} pong_corner;

/* D in q~ = (q - E) / D, by which the linear method scales its coordinates (paper, eq. 4 and 5). */
typedef enum pong_normalisation {
	PONG_NORMALISE_NONE = 0,
	PONG_NORMALISE_VARIANCE = 1,  /* as printed in the paper */
	PONG_NORMALISE_DEVIATION = 2, /* the standard deviation */
} pong_normalisation;

/* What is known of the cameras before any picture: standard deviations about the usual; 0 holds a number fast. */
typedef struct pong_calibrate_settings {
	pong_profile profile;             /* the paper's linear method, or the joint refinement */
	pong_normalisation normalisation; /* of the linear method */
	int width[2], height[2];          /* of the pictures, by pong_side, px */
	int frame_is_left_camera;         /* the table frame stands in the left camera: x left, y up, z along its axis;
					     otherwise placed views say where it is */
	double aspect;                    /* of fu / fv about 1 */
	double principal;                 /* of the principal point about the middle, parts of the picture's width */
	double distortion[5];             /* of k1 k2 p1 p2 k3 about 0 */
	double loss;                      /* corners farther off than so many sigma weigh less (Huber) */
} pong_calibrate_settings;

PONG_API void pong_calibrate_defaults(pong_profile profile, pong_calibrate_settings *settings);

/* The numbers that describe a camera, in the order of the covariance: fu fv cu cv (px), k1 k2 p1 p2 k3, a small
 * rotation about the camera's own x y z (rad), and its centre in the table frame (m). */
#define PONG_CAMERA_NUMBERS 15

typedef struct pong_calibration {
	pong_camera camera[2];
	double covariance[2 * PONG_CAMERA_NUMBERS][2 * PONG_CAMERA_NUMBERS]; /* left then right; NaN: not known */
	double sigma; /* of a corner, per axis, px: from the residuals */
	double rms;   /* of the corners' distances, px */
} pong_calibration;

/* What became of one view. */
typedef struct pong_view_result {
	double pose[3][4];       /* where it stood */
	double covariance[6][6]; /* rotation about the table frame's x y z (rad), position (m) */
	int corners[2];          /* by pong_side */
	double rms[2];           /* of the corners' distances, px */
} pong_view_result;

/* Calibrate both cameras at once. PONG_PAPER needs placed views in at least two planes; PONG_BEST starts from them
 * where they are there, or from boards in at least two poses. residuals[corner_count] (seen minus expected, px) and
 * results[view_count] may be NULL.
 * Returns PONG_FOUND, or PONG_ERROR_VALUE with the reason where the views do not determine two cameras. */
PONG_API int pong_calibrate(const pong_view *views, int view_count, const pong_corner *corners, int corner_count,
			    const pong_calibrate_settings *settings, pong_calibration *calibration,
			    pong_view_result *results, double (*residuals)[2], pong_error *error);

/* Score cameras on views that need not be those they were calibrated with: only the poses of the views are fitted, and
 * placement is not looked at. *rms is over all corners. */
PONG_API int pong_calibration_check(const pong_camera camera[2], const pong_view *views, int view_count,
				    const pong_corner *corners, int corner_count, double *rms,
				    pong_view_result *results, double (*residuals)[2], pong_error *error);

/* What the calibration alone does to a point that both cameras see: the covariance of the reconstructed position, m^2,
 * with perfect centres. Returns PONG_FOUND, or PONG_NONE where the point is out of sight of either camera. */
PONG_API int pong_calibration_error(const pong_calibration *calibration, const double position[3],
				    double covariance[3][3]);

/* The covariance as it would be with one more view, which is not placed, with these corners (their uv is not read) in
 * this pose. *after may be *before. */
PONG_API void pong_calibration_expect(const pong_calibration *before, const double pose[3][4],
				      const pong_corner *corners, int corner_count, pong_calibration *after);

/* A ball in both pictures, as a tracker recorded it. */
typedef struct pong_sighting {
	int32_t track; /* its flight */
	int64_t utime;
	double uv[2][2]; /* centres by pong_side, px */
} pong_sighting;

typedef struct pong_refinement {
	int sightings, flights, bounces;  /* what was used */
	double epipolar_before, epipolar; /* rms, px */
	double bounce_before, bounce;     /* rms height of the bounces over where they should be, m; NaN without */
	double rotation[3];               /* of the moved camera about its own axes, rad */
	double covariance[3][3];          /* rad^2 */
} pong_refinement;

/* Correct the direction of a camera that was knocked since *rig was calibrated: rays of a ball meet, and a ball that
 * bounces touches the table. Needs at least 20 sightings. Returns PONG_FOUND, or PONG_ERROR_VALUE. */
PONG_API int pong_refine(pong_rig *rig, pong_side knocked, const pong_sighting *sightings, int count,
			 pong_refinement *refinement, pong_error *error);

/* --------------------------------------------------------------------------------------------------------------
 * Settings: the methods and numbers of every stage. A profile fills them all; change what you must afterwards.
 */

typedef enum pong_detect_method {
	PONG_DETECT_DIFFERENCE = 0, /* the paper's difference to one earlier picture; finds a ball brighter than what is
				       behind it */
	PONG_DETECT_DOUBLE_DIFFERENCE = 1, /* to two earlier pictures; finds brighter and darker balls */
} pong_detect_method;

typedef enum pong_locate_method {
	PONG_LOCATE_GAUSSIAN = 0,    /* the paper's log-Gaussian, section 4.3 */
	PONG_LOCATE_CENTROID = 1,    /* centroid weighted by the difference image */
	PONG_LOCATE_EDGES = 2,       /* a sphere's outline fitted to edges on rays */
	PONG_LOCATE_PHOTOMETRIC = 3, /* a lit sphere fitted to all pixels */
} pong_locate_method;

typedef enum pong_reconstruct_method {
	PONG_RECONSTRUCT_LINEAR = 0, /* the paper's linear least squares */
	PONG_RECONSTRUCT_LIKELY = 1, /* the most likely point by both centres' covariances */
} pong_reconstruct_method;

typedef enum pong_state_method {
	PONG_STATE_TWO_HALVES = 0, /* the paper's smoothing, section 6, Fig. 8 */
	PONG_STATE_FLIGHT = 1,     /* the most probable flight, with spin, through all of its points and its bounces */
} pong_state_method;

typedef enum pong_predict_method {
	PONG_PREDICT_EULER = 0, /* the paper's: drag, Euler steps, constant factors at the bounce; section 6 */
	PONG_PREDICT_SPIN = 1,  /* drag and Magnus force, a bounce with friction, and the covariance of it all */
} pong_predict_method;

#define PONG_GAP_MAX 64 /* frames */

typedef struct pong_settings {
	struct {
		double ceiling;     /* the ball is looked for up to this height above the table, m */
		double margin;      /* and this far beyond the table's side lines, m */
		double behind;      /* and from this far behind the opponent's end line, m; up to the hit plane */
		double distance[2]; /* without a table: least and greatest distance from the camera, m */
	} region;
	struct {
		pong_detect_method method;
		int gap;         /* difference to the pictures so many, and twice as many, frames earlier */
		double contrast; /* a ball differs from them by at least this, grey levels */
	} detect;
	struct {
		pong_locate_method method;
		double sigma;    /* standard deviation of a centre, per axis, px, where the method tells none */
		double exposure; /* of the pictures, s: how long the streak of a flying ball is; 0 where unknown, or
				  * where pong_eye_set_exposure tells it */
	} locate;
	struct {
		pong_reconstruct_method method;
		double epipolar;      /* a pair's centres lie at most this far from each other's epipolar lines, px; */
		double epipolar_size; /* and this part of the ball's diameter farther: the larger the ball, the larger
					 are the errors of its centre */
		double size;          /* apparent and expected size agree within this part of the expected one */
	} reconstruct;
	struct {
		pong_state_method state;
		double gate;      /* a point of the same flight lies at most this far from where it is expected, m; */
		double gate_rate; /* and this much farther for every second since the last point, m/s */
		double lost;      /* a ball not seen for this long is lost, s */
		double speed;     /* faster than this no ball flies, m/s */
		double noise;     /* standard deviation of what neighbouring points err alike with, m; for points
				     without covariance, whose scatter is found out from themselves */
	} track;
	struct {
		pong_predict_method method;
		double step;      /* of the Euler integration, s */
		double horizon;   /* no prediction further ahead than this, s */
		double path_step; /* of the predicted path, s */
	} predict;
	struct {
		double margin;    /* the window reaches this far around the expected ball, px; */
		double diameters; /* and this many of its diameters */
	} window;
} pong_settings;

PONG_API void pong_settings_defaults(pong_profile profile, pong_settings *settings);

/* Change the settings that a rig.toml names, in sections called as the members above: [detect] gap = 8. On an error
 * *settings is unchanged. Returns PONG_FOUND or the errors of pong_rig_load. */
PONG_API int pong_settings_load(const char *path, pong_settings *settings, pong_error *error);

/* As pong_settings_load, from text of any length; name stands for the file in errors. */
PONG_API int pong_settings_parse(const char *text, const char *name, pong_settings *settings, pong_error *error);

/* --------------------------------------------------------------------------------------------------------------
 * Region: where in a picture a ball can be, and how large it is there (paper, section 4.1)
 */

typedef struct pong_region pong_region;

/* What can be seen over the table in one image row. */
typedef struct pong_region_row {
	int begin, end;            /* columns begin .. end - 1; begin == end: nothing in this row */
	double size_min, size_max; /* diameters that a ball can have there, px */
} pong_region_row;

/* The part of a camera's picture in which a ball over the table is seen: bounded by the table's projected side lines,
 * and above them by the planes that stand on them. Without a table: the whole picture.
 * Returns NULL and says why if no part of the picture is left. */
PONG_API pong_region *pong_region_new(const pong_rig *rig, pong_side side, const pong_settings *settings,
				      pong_error *error);
PONG_API void pong_region_free(pong_region *region);

/* Row v, which must be inside of the picture. */
PONG_API pong_region_row pong_region_get_row(const pong_region *region, int v);

/* --------------------------------------------------------------------------------------------------------------
 * Detect: five-point detection on the difference of two pictures (paper, section 4.2)
 */

/* A new picture, and two earlier ones of the same camera that it is compared with: not its neighbours, for a ball that
 * flies along the optical axis moves little from one to the next ("discontinuous frames"). earlier[1] is the older one;
 * the paper's method does not look at it. All three have the same size. */
typedef struct pong_pictures {
	pong_image current, earlier[2];
} pong_pictures;

/* A part of a picture and the sizes that a ball has in it: the search narrowed down by a prediction. */
typedef struct pong_window {
	int u, v, width, height;   /* px; it may reach over the picture's borders */
	double size_min, size_max; /* px */
} pong_window;

/* What the five points found. */
typedef struct pong_detection {
	double u, v;     /* centre of the five points, px; good to a pixel or so */
	double size;     /* N, the diameter, px */
	double contrast; /* mean difference inside less that around, grey levels */
} pong_detection;

typedef struct pong_detector pong_detector;

/* The region is borrowed: free it after the detector. */
PONG_API pong_detector *pong_detector_new(const pong_region *region, const pong_settings *settings, pong_error *error);
PONG_API void pong_detector_free(pong_detector *detector);

/* Remember what later pictures are compared with of this one: a search then does not read it again where nothing has
 * changed. Until a picture at the same place is remembered, the pixels there must stay as they are; the last 256 places
 * are. A search finds the same with and without. */
PONG_API void pong_detector_remember(pong_detector *detector, const pong_image *image);

/* Find what looks like a ball in the current picture and was not there earlier, best contrast first. The pictures have
 * the camera's size. With a window only what lies in it is searched, else (NULL) the whole region.
 * Returns how many were written to found[capacity]; 0 if there is none. */
PONG_API int pong_detect(pong_detector *detector, const pong_pictures *pictures, const pong_window *window,
			 pong_detection *found, int capacity);

/* --------------------------------------------------------------------------------------------------------------
 * Locate: the ball's centre to a part of a pixel, on the original picture (paper, section 4.3)
 */

/* What is wrong with a ball's picture. Its centre is less certain then, and its covariance says by how much. */
enum {
	PONG_CENTRE_CUT = 1,     /* the border of the picture cuts it */
	PONG_CENTRE_COVERED = 2, /* something hides a part of it */
};

/* What the photometric method finds besides: the light on the ball, which the other camera sees, too. Nine terms of a
 * polynomial in the surface's normal (table frame, grey levels), and the radius (px); their covariance, and that of
 * u and v with them. pong_reconstruct takes the light of both centres as one. */
enum { PONG_LIGHT_TERMS = 10 };
typedef struct pong_light {
	int known; /* 0: the method tells none */
	float term[PONG_LIGHT_TERMS];
	float covariance[PONG_LIGHT_TERMS][PONG_LIGHT_TERMS];
	float with_centre[2][PONG_LIGHT_TERMS];
} pong_light;

typedef struct pong_centre {
	double u, v;             /* px */
	double radius;           /* px */
	double covariance[2][2]; /* of u, v; px^2 */
	double common;           /* correlation of its error with that of the other camera's centre of the same ball */
	unsigned flags;          /* PONG_CENTRE_CUT | PONG_CENTRE_COVERED; 0: all of the ball is seen */
	pong_light light;
} pong_centre;

/* Fit the centre of a detected ball: where the sphere's centre is seen in the middle of the exposure. `streak` is how
 * the ball's picture changes during the exposure, as pong_streak tells; NULL where that is unknown. Returns PONG_FOUND,
 * or PONG_NONE where the pixels don't look like a ball. */
PONG_API int pong_locate(const pong_camera *camera, const pong_pictures *pictures, const pong_detection *detection,
			 const double streak[3], const pong_settings *settings, pong_centre *centre);

/* How the picture of a ball at a position (m), with a velocity (m/s), changes during an exposure (s): by how many
 * pixels it moves along u and v, and by which part of its size it grows. Returns PONG_FOUND, or PONG_NONE where the
 * ball is not in front of the camera. */
PONG_API int pong_streak(const pong_camera *camera, const double position[3], const double velocity[3], double exposure,
			 double streak[3]);

/* The same of a ball that was seen but once before, at a position (m) so many seconds ago, and is detected now; its
 * size is taken as constant. Returns PONG_FOUND, or PONG_NONE where no ball moves as far. */
PONG_API int pong_streak_since(const pong_camera *camera, const double position[3], double seconds,
			       const pong_detection *now, double exposure, double streak[3]);

/* --------------------------------------------------------------------------------------------------------------
 * Reconstruct: from two centres to a point in the table frame (paper, section 5 and appendix)
 */

typedef struct pong_point {
	int64_t utime;
	int64_t frame;
	double position[3];
	double covariance[3][3]; /* m^2; all zero where unknown: the best profile then finds it out */
} pong_point;

/* The fundamental matrix F of ideal (undistorted) pixels: right' F left = 0 (paper, appendix). */
PONG_API void pong_fundamental(const pong_camera camera[2], double F[3][3]);

/* How far right_uv lies from the epipolar line of left_uv, px: signed, positive below or, for upright lines, to the
 * right of it. Lens distortion is removed first. */
PONG_API double pong_epipolar_distance(const pong_camera camera[2], const double left_uv[2], const double right_uv[2]);

/* The point that both cameras see, by linear least squares (paper, eq. 14 and 15), lens distortion removed first.
 * Returns PONG_FOUND, or PONG_NONE where the rays are parallel or meet behind a camera. */
PONG_API int pong_triangulate(const pong_camera camera[2], const double left_uv[2], const double right_uv[2],
			      double position[3]);

/* Gate a pair of centres by epipolar distance and by the ball's size, and reconstruct. Fills position and covariance
 * of *point (not utime and frame). Returns PONG_FOUND, or PONG_NONE where the two are not one ball. */
PONG_API int pong_reconstruct(const pong_rig *rig, const pong_centre *left, const pong_centre *right,
			      const pong_settings *settings, pong_point *point);

/* --------------------------------------------------------------------------------------------------------------
 * Track: which points belong to one flight, and the ball's state that follows from them
 */

/* What the full state of a ball is made of, and the place of each part in its covariance. The coefficients are those
 * of pong_ball_spec, as this flight has shown them; the height is the table's where this flight bounces; the kick is
 * what its next bounce adds to the velocity along x, z. */
enum {
	PONG_STATE_POSITION = 0,
	PONG_STATE_VELOCITY = 3,
	PONG_STATE_SPIN = 6,
	PONG_STATE_DRAG = 9,
	PONG_STATE_MAGNUS = 10,
	PONG_STATE_RESTITUTION = 11,
	PONG_STATE_FRICTION = 12,
	PONG_STATE_GRIP = 13,
	PONG_STATE_HEIGHT = 14,
	PONG_STATE_KICK_X = 15,
	PONG_STATE_KICK_Z = 16,
	PONG_STATE_SIZE = 17
};

/* The ball at one moment. */
typedef struct pong_state {
	int64_t utime;
	double position[3]; /* m */
	double velocity[3]; /* m/s */
	int has_spin;       /* whether what follows is known: not from the paper's method */
	double spin[3];     /* rad/s */
	double coefficients[PONG_STATE_SIZE - PONG_STATE_DRAG]; /* PONG_STATE_DRAG to PONG_STATE_KICK_Z */
	double covariance[PONG_STATE_SIZE][PONG_STATE_SIZE];
} pong_state;

typedef enum pong_track_event {
	PONG_TRACK_REJECTED = 0, /* the point fits no flight: it was not used */
	PONG_TRACK_BEGUN = 1,    /* the first point of a flight */
	PONG_TRACK_FOLLOWED = 2, /* a further point of the flight */
} pong_track_event;

typedef struct pong_track pong_track;

PONG_API pong_track *pong_track_new(const pong_rig *rig, const pong_settings *settings, pong_error *error);
PONG_API void pong_track_free(pong_track *track);

/* Add a point. Points that come late or twice are rejected. */
PONG_API pong_track_event pong_track_push(pong_track *track, const pong_point *point);

/* Say that no ball was seen at this time: a ball not seen for too long is lost. */
PONG_API void pong_track_miss(pong_track *track, int64_t utime);

/* The number of the flight, 1 for the first; 0 while there is none. */
PONG_API int32_t pong_track_id(const pong_track *track);

/* How many points the flight has, 0 while there is none. */
PONG_API int pong_track_count(const pong_track *track);

/* The ball's state as far as the flight's points tell, from two points on. Its time is the estimate's own, not
 * necessarily that of the last point. Returns PONG_FOUND or PONG_NONE. */
PONG_API int pong_track_state(const pong_track *track, pong_state *state);

/* The same from the latest few points only: less smooth, but truer of where the ball is just now. */
PONG_API int pong_track_recent_state(const pong_track *track, pong_state *state);

/* --------------------------------------------------------------------------------------------------------------
 * Predict: the flight to come (paper, section 6)
 */

#define PONG_PATH_CAPACITY 128

typedef struct pong_prediction {
	int64_t utime;               /* of the state that it starts from */
	int has_hit;                 /* 0: the ball does not come to the hit plane within the horizon, or not by a way
					that can be known: it meets the net or the table's edge */
	pong_state hit;              /* on the hit plane z = rig.hit_z */
	double hit_covariance[4][4]; /* of x, y, z (m) and time (s); NaN where the method knows none */
	int has_bounce;
	pong_state bounce; /* the next bounce on the table: position, and velocity before it */
	int has_top;
	pong_state top; /* the highest point after a bounce to come, for the robot that may choose; where there is a
			   hit, be it before or behind its plane */
	double spin[3]; /* rad/s; NaN where unknown */
	int path_count; /* the way to the hit, or to the horizon */
	struct {
		int64_t utime;
		double position[3];
	} path[PONG_PATH_CAPACITY];
} pong_prediction;

/* Fly on from a state to the hit plane. Returns PONG_FOUND, or PONG_NONE if the state is not finite. */
PONG_API int pong_predict(const pong_rig *rig, const pong_state *state, const pong_settings *settings,
			  pong_prediction *prediction);

/* Where the ball is at another time, no earlier than the state's; with a covariance where the state has one: from the
 * track's recent state, what to expect of the next picture, and how far around to look. Returns PONG_FOUND or
 * PONG_NONE. */
PONG_API int pong_predict_at(const pong_rig *rig, const pong_state *state, int64_t utime, const pong_settings *settings,
			     pong_state *then);

/* --------------------------------------------------------------------------------------------------------------
 * Window: where in the next pictures the ball is expected
 */

/* The window of one camera's picture around a ball at `position`. PONG_NONE where that is out of its sight. */
PONG_API int pong_window_around(const pong_rig *rig, pong_side side, const double position[3],
				const pong_settings *settings, pong_window *window);

/* --------------------------------------------------------------------------------------------------------------
 * Eye: the stages joined. Push stereo pairs, get ball and prediction.
 */

/* Why a pair has a ball, or has none. */
typedef enum pong_outcome {
	PONG_SEEN = 0,         /* one ball, in both pictures */
	PONG_NOTHING = 1,      /* no ball in either picture */
	PONG_ONE_EYED = 2,     /* a ball in one picture only */
	PONG_MISMATCH = 3,     /* balls in both, but none that could be the same */
	PONG_REJECTED = 4,     /* a ball that fits no flight */
	PONG_OUT_OF_ORDER = 5, /* the pair is not later than the one before: dropped */
	PONG_OUTCOMES = 6
} pong_outcome;

/* The ball in one stereo pair. */
typedef struct pong_ball {
	int64_t utime;
	int64_t frame;
	int32_t track;            /* the flight that it belongs to */
	double position[3];       /* m */
	double velocity[3];       /* m/s; NaN on the first sight */
	double covariance[3][3];  /* of the position, m^2 */
	pong_centre centre[2];    /* by pong_side */
	double epipolar_distance; /* px */
} pong_ball;

typedef struct pong_sight {
	pong_outcome outcome;
	int detections[2]; /* how many places looked like a ball, by pong_side */
	int windowed;      /* whether the search was narrowed down by a prediction */
	int has_ball;
	pong_ball ball;
	int observations; /* points of the flight so far */
	int has_prediction;
	pong_prediction prediction;
} pong_sight;

typedef struct pong_eye pong_eye;

/* Both structs are copied. Returns NULL and says why where the rig or a setting is impossible. */
PONG_API pong_eye *pong_eye_new(const pong_rig *rig, const pong_settings *settings, pong_error *error);
PONG_API void pong_eye_free(pong_eye *eye);

/* How long a camera exposes its pictures, s: from the next pair on a flying ball's streak is known. It stays so until
 * it is told anew; 0, or more than 0.1: unknown. Where settings->locate.exposure says it, that stands. */
PONG_API void pong_eye_set_exposure(pong_eye *eye, pong_side side, double exposure);

/* Look at one stereo pair; the pictures are not kept. *sight is always filled.
 * Returns PONG_FOUND with a ball, PONG_NONE without, PONG_ERROR_VALUE if a picture has not its camera's size. */
PONG_API int pong_eye_push(pong_eye *eye, int64_t utime, int64_t frame, const pong_image *left, const pong_image *right,
			   pong_sight *sight, pong_error *error);

/* The same in steps, for those who have a thread for each camera, and are in a hurry:
 *
 *     pong_eye_expect(eye, utime)                         first, in one thread
 *     pong_eye_look(eye, PONG_LEFT, &left, &error)        both at the same time, each in its own thread,
 *     pong_eye_look(eye, PONG_RIGHT, &right, &error)      or one after the other
 *     pong_eye_join(eye, frame, &sight)                   when both have returned: the ball
 *     pong_eye_predict(eye, &sight)                       the prediction
 *     pong_eye_keep(eye)                                  from now on the pictures may change
 *
 * What comes of it is that of pong_eye_push, to the bit. Whoever uses threads makes the earlier step's writes seen by
 * the later one, as any mutex or condition variable does. */

/* Begin with the pair exposed at `utime`: work out where its ball must be. That can be done before the pictures are
 * there. Returns PONG_FOUND, or PONG_NONE where the pair is not later than the one before: drop it then. */
PONG_API int pong_eye_expect(pong_eye *eye, int64_t utime);

/* Look at one camera's picture of the pair. Its pixels must stay until pong_eye_keep, or, where that is left out, until
 * the next pong_eye_expect. Returns how many places look like a ball, or PONG_ERROR_VALUE if the picture has not its
 * camera's size. */
PONG_API int pong_eye_look(pong_eye *eye, pong_side side, const pong_image *image, pong_error *error);

/* Find the pair's ball, when both pictures were looked at. *sight is always filled, but for the prediction. Returns
 * PONG_FOUND with a ball, PONG_NONE without, or where a picture was refused. */
PONG_API int pong_eye_join(pong_eye *eye, int64_t frame, pong_sight *sight);

/* Predict the flight of the ball that pong_eye_join has found. Returns PONG_FOUND, or PONG_NONE where there is no ball,
 * or too little is known of it. */
PONG_API int pong_eye_predict(pong_eye *eye, pong_sight *sight);

/* Copy the pictures that were looked at: the next ones are compared with them. A picture that is not kept is forgotten
 * by the next pong_eye_expect: nothing is compared with it. */
PONG_API void pong_eye_keep(pong_eye *eye);

#ifdef __cplusplus
}
#endif

#endif

/* Matches a pair in memory, says what was found, and writes the view between both cameras as
 * view.pgm. The pair is made here: a card in front of a wall. Yours comes from cameras or files. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <vantage_c.h>

enum { WIDTH = 320, HEIGHT = 200, WALL_PX = 5, CARD_PX = 20 };

static unsigned char left_pixels[HEIGHT][WIDTH];
static unsigned char right_pixels[HEIGHT][WIDTH];
static float disparity_px[HEIGHT][WIDTH];
static unsigned char view_pixels[HEIGHT][WIDTH];

static int is_card(int x, int y) { return x >= 120 && x < 220 && y >= 60 && y < 140; }

static void make_pair(void) {
  for (int y = 0; y < HEIGHT; ++y) {
    for (int x = 0; x < WIDTH; ++x) {
      left_pixels[y][x] = (unsigned char)(rand() % 200 + (is_card(x, y) ? 55 : 0));
      right_pixels[y][x] = (unsigned char)(rand() % 200);
    }
  }
  for (int is_near = 0; is_near <= 1; ++is_near) {
    const int shift = is_near ? CARD_PX : WALL_PX;
    for (int y = 0; y < HEIGHT; ++y) {
      for (int x = shift; x < WIDTH; ++x) {
        if (is_card(x, y) == is_near) {
          right_pixels[y][x - shift] = left_pixels[y][x];
        }
      }
    }
  }
}

/* Prints the error and ends the program where there is one. */
static void check(vantage_status status) {
  if (status != VANTAGE_OK) {
    fprintf(stderr, "error: %s\n", vantage_last_error());
    exit(1);
  }
}

int main(void) {
  make_pair();
  const char* options[] = {"preset=balanced", "disparities=0:40"};
  vantage_matcher* matcher = NULL;
  check(vantage_matcher_create(options, 2, &matcher));

  vantage_image left = {.struct_size = sizeof left,
                        .pixels = left_pixels,
                        .width_px = WIDTH,
                        .height_px = HEIGHT,
                        .channels = 1,
                        .bits = 8};
  vantage_image right = left;
  right.pixels = right_pixels;
  vantage_pair* pair = NULL;
  check(vantage_match(matcher, &left, &right, &pair));
  const char* remark;
  for (size_t i = 0; (remark = vantage_pair_remark(pair, i, NULL)) != NULL; ++i) {
    printf("remark: %s\n", remark);
  }

  vantage_picture map = {.struct_size = sizeof map,
                         .pixels = disparity_px,
                         .width_px = WIDTH,
                         .height_px = HEIGHT,
                         .channels = 1,
                         .bits = 32};
  check(vantage_pair_disparity(pair, VANTAGE_LEFT, &map));
  const float wall = disparity_px[30][60], card = disparity_px[100][170];
  printf("%s: wall %.2f px, card %.2f px\n", vantage_version(), wall, card);

  vantage_picture view = map;
  view.pixels = view_pixels;
  view.bits = 8;
  check(vantage_pair_view(pair, 0.5, 0, &view));
  FILE* file = fopen("view.pgm", "wb");
  if (file != NULL) {
    fprintf(file, "P5\n%d %d\n255\n", WIDTH, HEIGHT);
    fwrite(view_pixels, 1, sizeof view_pixels, file);
    fclose(file);
  }
  vantage_pair_destroy(pair);
  vantage_matcher_destroy(matcher);
  return fabsf(wall - WALL_PX) < 0.5F && fabsf(card - CARD_PX) < 0.5F ? 0 : 1;
}

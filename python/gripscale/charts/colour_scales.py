"""Colour scales of charts: every eighth colour of matplotlib's scales of those names.

Neither matplotlib nor Bokeh is needed; between two of these colours any other is interpolated, with
an error of 5 in 255 at most.
"""

SCALES = {
    "Viridis": (
        "440154 460c5f 47186a 482273 472c7b 453681 424085 3e4989 3a528b 365a8c 32628d "
        "2f6a8d 2c728e 287a8e 26818e 23898d 20908c 1e978a 1e9e88 21a685 27ad80 30b47a "
        "3dbb74 4bc26c 5bc862 6dce58 81d34c 95d73f aadb32 bfdf24 d4e11a e9e419 fde724"
    ),
    "Plasma": (
        "0c0786 21058f 310496 3f039c 4c02a1 5901a4 6500a7 7200a8 7e03a7 8908a5 9511a1 "
        "9f1a9b a92395 b22c8e bb3586 c33e7f cb4777 d14f71 d8586a df6163 e56b5c ea7455 "
        "ef7e4e f48947 f79341 fa9f3a fcaa33 fdb62d fdc328 fbd024 f8dd24 f4ea26 eff821"
    ),
    "Cividis": (
        "00204c 00265a 002b68 00306f 06366e 1e3c6c 2c416b 37476b 414d6b 49536b 51586c "
        "595e6d 60646e 686a70 6f6f72 757575 7c7b78 838178 8b8778 938d78 9b9377 a39a75 "
        "aba174 b4a771 bcae6e c5b56b cdbc67 d6c363 dfcb5d e8d257 f1da50 fbe147 ffe945"
    ),
    "Inferno": (
        "000003 030212 0a0723 140b36 200c4a 2e0a5a 3c0965 4a0b6a 570f6d 63146e 70196e "
        "7d1d6c 892269 962666 a32b61 af315b bb3754 c53d4d d04544 da4e3b e35832 ea6428 "
        "f0701e f57e14 f98c09 fb9b06 fbaa0e fbb91e f8c931 f5d948 f1e864 f2f485 fcfea4"
    ),
}

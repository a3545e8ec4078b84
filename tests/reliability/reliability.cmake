# Tests of what users rely on: pictures are the same again, and noise is what the theory says.
pellucid_test(reliability_tests SOURCES reliability/test_noise.cpp reliability/test_same_pictures.cpp LIBRARIES pellucid_lab)

# OpenVDB::openvdb. Its own FindOpenVDB.cmake asks for libraries that reading and writing files does not need.
find_path(OpenVDB_INCLUDE_DIR openvdb/openvdb.h REQUIRED)
find_library(OpenVDB_LIBRARY openvdb REQUIRED)
find_package(Imath REQUIRED)
add_library(OpenVDB::openvdb INTERFACE IMPORTED)
target_include_directories(OpenVDB::openvdb SYSTEM INTERFACE ${OpenVDB_INCLUDE_DIR})
target_link_libraries(OpenVDB::openvdb INTERFACE ${OpenVDB_LIBRARY} Imath::Imath TBB::tbb)

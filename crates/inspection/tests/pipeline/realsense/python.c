/* The symbols of the Python interpreter that pyrealsense2, which contains librealsense, needs when it is loaded; the functions
 * of librealsense never use them. Its other Python functions are resolved when they are called, which never happens. */
#define THING(name) char name[1024];

THING(PyBaseObject_Type) THING(PyBool_Type) THING(PyByteArray_Type) THING(PyCFunction_Type) THING(PyCapsule_Type)
THING(PyDict_Type) THING(PyExc_BufferError) THING(PyExc_ImportError) THING(PyExc_IndexError) THING(PyExc_MemoryError)
THING(PyExc_OverflowError) THING(PyExc_RuntimeError) THING(PyExc_StopIteration) THING(PyExc_SystemError)
THING(PyExc_TypeError) THING(PyExc_ValueError) THING(PyFloat_Type) THING(PyInstanceMethod_Type) THING(PyMethod_Type)
THING(PyModule_Type) THING(PyObject_GenericGetDict) THING(PyObject_GenericSetDict) THING(PyProperty_Type)
THING(PySlice_Type) THING(PyStaticMethod_Type) THING(PyType_Type) THING(_Py_FalseStruct) THING(_Py_NoneStruct)
THING(_Py_NotImplementedStruct) THING(_Py_TrueStruct)

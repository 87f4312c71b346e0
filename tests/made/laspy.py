# Writes the same ground in every version and point format of LAS, plain and packed, into the folder named.
import sys
try:
    import laspy, numpy
except ImportError:
    print('none'); sys.exit()
k = numpy.arange(900)
x, y = 2600000.25 + k % 30, 1200000.75 + k // 30
z = 50 + 0.5 * (x - 2600000) - 0.25 * (y - 1200000)
n = 0
for version, formats in (('1.2', (0, 1, 2, 3)), ('1.4', (0, 1, 6, 7, 8))):
    for fmt in formats:
        for end in ('las', 'laz'):
            header = laspy.LasHeader(point_format=fmt, version=version)
            header.offsets, header.scales = [2600000, 1200000, 0], [0.001] * 3
            cloud = laspy.LasData(header)
            cloud.x, cloud.y, cloud.z = x, y, numpy.where(k % 7 == 0, z + 9, z)
            cloud.classification = numpy.where(k % 7 == 0, 5, 2).astype('u1')
            cloud.write(f'{sys.argv[1]}/{version}_{fmt}.{end}')
            n += 1
print(n)

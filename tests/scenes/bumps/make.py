"""Makes bumps.gltf, normal.png and sphere.bin: a metal sphere with a periodic map of small bumps, repeated 16 x 8 times. Run it here."""
import json
import math
import random
import struct
import zlib

N=64; rnd=random.Random(7)
waves=[]
for _ in range(28):
    a=rnd.uniform(0,math.pi); f=rnd.uniform(6,13)
    kx,ky=round(f*math.cos(a)),round(f*math.sin(a))
    if kx or ky: waves.append((kx,ky,rnd.uniform(0,2*math.pi),rnd.uniform(.5,1)/math.hypot(kx,ky)))
def slope(x,y):
    sx=sy=0
    for kx,ky,p,w in waves:
        c=-math.sin(2*math.pi*(kx*x+ky*y)/N+p)*w
        sx+=kx*c; sy+=ky*c
    return sx,sy
S=[[slope(x+.5,y+.5) for x in range(N)] for y in range(N)]
rms=math.sqrt(sum(a*a+b*b for r in S for a,b in r)/N/N)
k=0.38/rms
rows=b''
for r in S:
    rows+=b'\0'
    for a,b in r:
        a*=k;b*=k
        l=math.sqrt(1+a*a+b*b)
        rows+=bytes(round((v*.5+.5)*255) for v in (-a/l,-b/l,1/l))
def chunk(t,d): return struct.pack('>I',len(d))+t+d+struct.pack('>I',zlib.crc32(t+d))
open('normal.png','wb').write(b'\x89PNG\r\n\x1a\n'+chunk(b'IHDR',struct.pack('>IIBBBBB',N,N,8,2,0,0,0))+chunk(b'IDAT',zlib.compress(rows,9))+chunk(b'IEND',b''))
U,V=48,24
pos=[];nor=[];uv=[]
for j in range(V+1):
    t=math.pi*j/V
    for i in range(U+1):
        p=2*math.pi*i/U
        n=(math.sin(t)*math.cos(p),math.cos(t),-math.sin(t)*math.sin(p))
        pos.append(n);nor.append(n);uv.append((16*i/U,8*j/V))
idx=[]
for j in range(V):
    for i in range(U):
        a=j*(U+1)+i;b=a+U+1
        if j>0: idx+=[a,b,a+1]
        if j<V-1: idx+=[a+1,b,b+1]
f=lambda L:b''.join(struct.pack('<%df'%len(v),*v) for v in L)
P,Nn,T=f(pos),f(nor),f(uv); I=struct.pack('<%dH'%len(idx),*idx)
I+=b'\0'*(-len(I)%4)
buf=P+Nn+T+I
open('sphere.bin','wb').write(buf)
n=len(pos)
r=lambda v:struct.unpack('<f',struct.pack('<f',v))[0]
mn=[min(r(p[c]) for p in pos) for c in range(3)];mx=[max(r(p[c]) for p in pos) for c in range(3)]
g={"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2},"indices":3,"material":0}]}],
"materials":[{"name":"bumps","pbrMetallicRoughness":{"baseColorFactor":[0.9,0.9,0.9,1],"metallicFactor":1,"roughnessFactor":0.3},"normalTexture":{"index":0}}],
"textures":[{"source":0,"sampler":0}],"samplers":[{"magFilter":9729,"minFilter":9987,"wrapS":10497,"wrapT":10497}],
"images":[{"uri":"normal.png"}],
"buffers":[{"uri":"sphere.bin","byteLength":len(buf)}],
"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":len(P),"target":34962},{"buffer":0,"byteOffset":len(P),"byteLength":len(Nn),"target":34962},{"buffer":0,"byteOffset":len(P)+len(Nn),"byteLength":len(T),"target":34962},{"buffer":0,"byteOffset":len(P)+len(Nn)+len(T),"byteLength":len(idx)*2,"target":34963}],
"accessors":[{"bufferView":0,"componentType":5126,"count":n,"type":"VEC3","min":mn,"max":mx},{"bufferView":1,"componentType":5126,"count":n,"type":"VEC3"},{"bufferView":2,"componentType":5126,"count":n,"type":"VEC2"},{"bufferView":3,"componentType":5123,"count":len(idx),"type":"SCALAR"}]}
open('bumps.gltf','w').write(json.dumps(g,indent=2)+'\n')
